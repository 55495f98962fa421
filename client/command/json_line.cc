#include "client/command/json_line.h"

#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/time_util.h>

#include <array>
#include <charconv>

namespace homing::client {
namespace {

// The shortest decimal that is this float32: 161.2, not 161.1999969482422.
double Shortest(float value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  double result = 0;
  std::from_chars(text.data(), end, result);
  return result;
}

Json Time(bool known, const google::protobuf::Timestamp& time) {
  return known ? Json(google::protobuf::util::TimeUtil::ToString(time)) : Json();
}

Json LandmarkObject(const v1::Fingerprint& fingerprint) {
  return {{"landmark", fingerprint.landmark()},
          {"side", Word(fingerprint.side())},
          {"x", Shortest(fingerprint.x())},
          {"y", Shortest(fingerprint.y())},
          {"count", fingerprint.count()}};
}

}  // namespace

std::string Word(v1::Side side) { return side == v1::SIDE_RIGHT ? "RIGHT" : "LEFT"; }

std::string Word(v1::Motion motion) {
  if (motion == v1::MOTION_STANDING) return "STANDING";
  return motion == v1::MOTION_TURNING ? "TURNING" : "MOVING";
}

std::string Word(v1::Outcome outcome) {
  if (outcome == v1::OUTCOME_MATCH) return "MATCH";
  return outcome == v1::OUTCOME_UNKNOWN_PLACE ? "UNKNOWN_PLACE" : "AMBIGUOUS";
}

std::string Word(v1::Direction direction) {
  if (direction == v1::DIRECTION_HOMEWARD) return "HOMEWARD";
  return direction == v1::DIRECTION_OUTWARD ? "OUTWARD" : "UNKNOWN";
}

std::string Word(v1::Journey::State state) {
  return state == v1::Journey::STATE_FINISHED ? "FINISHED" : "ACTIVE";
}

std::string Word(v1::CameraDirection direction) {
  if (direction == v1::CAMERA_DIRECTION_ACROSS) return "ACROSS";
  if (direction == v1::CAMERA_DIRECTION_ALONG) return "ALONG";
  return direction == v1::CAMERA_DIRECTION_MIXED ? "MIXED" : "UNKNOWN";
}

Json ToJson(const v1::RecordJourneyResponse& answer) {
  Json landmarks = Json::array();
  for (const auto& landmark : answer.landmarks()) {
    landmarks.push_back(LandmarkObject(landmark.fingerprint()));
  }
  return {{"sequence", answer.sequence()},
          {"next_sequence", answer.next_sequence()},
          {"frame", answer.has_frame() ? answer.frame() : answer.sequence()},
          {"step", answer.has_step() ? Json(answer.step()) : Json()},
          {"motion", Word(answer.motion())},
          {"landmarks", std::move(landmarks)}};
}

Json ToJson(const v1::Match& match) {
  return {{"journey", match.journey()}, {"landmark", match.landmark()}, {"step", match.step()},
          {"side", Word(match.side())}, {"delta", match.delta()},       {"p", match.p()},
          {"p_t", match.p_t()}};
}

namespace {

Json ToArray(const google::protobuf::RepeatedPtrField<v1::Match>& matches) {
  Json array = Json::array();
  for (const v1::Match& match : matches) array.push_back(ToJson(match));
  return array;
}

}  // namespace

Json ToJson(const v1::LocalizeResponse& answer) {
  Json interval;
  if (answer.has_interval()) {
    interval = Json::array({answer.interval().first(), answer.interval().last()});
  }
  return {{"sequence", answer.sequence()},
          {"frame", answer.has_frame() ? answer.frame() : answer.sequence()},
          {"outcome", Word(answer.outcome())},
          {"motion", Word(answer.motion())},
          {"journey", answer.journey().empty() ? Json() : Json(answer.journey())},
          {"step", answer.has_step() ? Json(answer.step()) : Json()},
          {"step_frame", answer.has_step_frame() ? Json(answer.step_frame()) : Json()},
          {"probability", answer.probability()},
          {"interval", std::move(interval)},
          {"progress_home", answer.has_progress_home() ? Json(answer.progress_home()) : Json()},
          {"direction", Word(answer.direction())},
          {"speed_ratio", answer.has_speed_ratio() ? Json(answer.speed_ratio()) : Json()},
          {"turn", answer.has_turn() ? Json(answer.turn()) : Json()},
          {"path_offset", answer.has_path_offset() ? Json(answer.path_offset()) : Json()},
          {"on_route", answer.on_route()},
          {"landmark", answer.has_landmark() ? Json(answer.landmark()) : Json()},
          {"similarity", answer.has_similarity() ? Json(answer.similarity()) : Json()},
          {"matches", ToArray(answer.matches())}};
}

Json ToJson(const v1::MatchLandmarksResponse& answer) {
  Json seen = Json::array();
  for (const v1::Fingerprint& fingerprint : answer.seen()) {
    Json landmark = LandmarkObject(fingerprint);
    // A landmark that is only seen has no number yet.
    landmark.erase("landmark");
    seen.push_back(std::move(landmark));
  }
  return {{"motion", Word(answer.motion())},
          {"seen", std::move(seen)},
          {"matches", ToArray(answer.matches())}};
}

Json ToJson(const v1::Journey& journey) {
  return {{"journey", journey.name()},
          {"state", Word(journey.state())},
          {"step_count", journey.step_count()},
          {"landmark_count", journey.landmark_count()},
          {"fingerprint_count", journey.fingerprint_count()},
          {"next_sequence", journey.next_sequence()},
          {"deviation_model", journey.settings().deviation_model()},
          {"readers",
           Json(std::vector<std::string>(journey.readers().begin(), journey.readers().end()))},
          {"create_time", Time(journey.has_create_time(), journey.create_time())},
          {"start_time", Time(journey.has_start_time(), journey.start_time())},
          {"end_time", Time(journey.has_end_time(), journey.end_time())}};
}

Json ToJson(const v1::JourneySettings& settings) {
  google::protobuf::util::JsonPrintOptions options;
  options.preserve_proto_field_names = true;
  options.always_print_primitive_fields = true;
  std::string text;
  const auto status = google::protobuf::util::MessageToJsonString(settings, &text, options);
  return status.ok() ? Json::parse(text, nullptr, /*allow_exceptions=*/false) : Json();
}

Json ToJson(const v1::Landmark& landmark) {
  return {{"landmark", landmark.landmark()},
          {"side", Word(landmark.side())},
          {"first_step", landmark.first_step()},
          {"last_step", landmark.last_step()},
          {"fingerprint_count", landmark.fingerprint_count()},
          {"spread", landmark.spread()}};
}

Json ToJson(const v1::DeviationModel& model) {
  return {{"deviation_model", model.name()},
          {"mu", model.mu()},
          {"sigma", model.sigma()},
          {"observations", model.observations()},
          {"ks_distance", model.ks_distance()},
          {"width", model.width()},
          {"height", model.height()}};
}

Json ToJson(const std::string& journey, const v1::AnalyzeAliasingResponse& report) {
  Json line{{"journey", journey},
            {"median_steps", report.has_median_steps() ? Json(report.median_steps()) : Json()},
            {"most_steps", report.has_most_steps() ? Json(report.most_steps()) : Json()},
            {"indistinct_share", report.indistinct_share()},
            {"twins", Json::array()}};
  for (const v1::Twins& twins : report.twins()) {
    line["twins"].push_back({{"step", twins.first_step()},
                             {"looks_like", twins.second_step()},
                             {"confusion", twins.confusion()}});
  }
  return line;
}

}  // namespace homing::client
