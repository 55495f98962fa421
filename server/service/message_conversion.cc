#include "server/service/message_conversion.h"

#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"
#include "proto/wire/enum_conversion.h"
#include "proto/wire/settings_conversion.h"

namespace homing::server {
namespace {

void EncodeMatch(const std::string& journey, const Match& match, v1::Match* message) {
  message->set_journey(journey);
  message->set_landmark(match.landmark);
  message->set_step(match.step);
  message->set_side(wire::ToProto(match.side));
  message->set_delta(match.similarity.delta);
  message->set_p(match.similarity.p);
  message->set_p_t(match.similarity.p_t);
}

void EncodePosition(const Position& position, const LocalizationSession& session,
                    v1::LocalizeResponse* message) {
  message->set_outcome(wire::ToProto(position.outcome));
  message->set_direction(wire::ToProto(position.direction));
  message->set_probability(position.probability);
  message->set_unknown_probability(position.unknown_probability);
  message->set_on_route(1 - position.unknown_probability);
  if (position.speed_ratio) message->set_speed_ratio(*position.speed_ratio);
  if (position.path_offset) message->set_path_offset(*position.path_offset);
  if (position.step) {
    message->set_journey(session.journey_name(position.journey));
    message->set_step(*position.step);
    message->mutable_interval()->set_first(position.interval_first);
    message->mutable_interval()->set_last(position.interval_last);
    message->set_progress_home(position.progress_home);
  }
}

// 0 and unset: the default.
MatchOptions DecodeMatchOptions(int max_matches, bool has_threshold, double threshold) {
  MatchOptions options;
  options.max_matches = max_matches == 0 ? options.max_matches : max_matches;
  options.threshold = has_threshold ? threshold : options.threshold;
  return options;
}

absl::StatusOr<std::optional<Camera>> DecodeCamera(bool present, const v1::Camera& message,
                                                   const std::string& field) {
  if (!present) {
    return std::nullopt;
  }
  HOMING_ASSIGN_OR_RETURN(const Camera camera, wire::FromProto(message, field));
  return camera;
}

absl::StatusOr<LocalizationPrior> DecodePrior(const v1::LocalizePrior& message) {
  LocalizationPrior prior;
  prior.journey = message.journey();
  prior.start.step = message.step();
  if (!v1::Direction_IsValid(message.direction())) {
    return MustBe("config.prior.direction", static_cast<int>(message.direction()),
                  "a value of Direction");
  }
  prior.start.direction = static_cast<Direction>(message.direction());
  prior.start.probability = message.probability();
  if (message.has_path_offset()) prior.start.path_offset = message.path_offset();
  return prior;
}

absl::StatusOr<FramePair> DecodeFramePair(const v1::FramePair& message, const std::string& field,
                                          const wire::WireLimits& limits) {
  FramePair pair;
  HOMING_ASSIGN_OR_RETURN(pair.first, wire::FromProto(message.first(), field + ".first", limits));
  HOMING_ASSIGN_OR_RETURN(pair.second,
                          wire::FromProto(message.second(), field + ".second", limits));
  return pair;
}

SeenFingerprints DecodeFingerprints(const v1::FingerprintSet& message) {
  SeenFingerprints seen{message.width(), message.height(), {}};
  for (const v1::Fingerprint& fingerprint : message.fingerprints()) {
    SeenLandmark landmark;
    landmark.x = fingerprint.x();
    landmark.y = fingerprint.y();
    landmark.count = fingerprint.count();
    seen.landmarks.push_back(landmark);
  }
  return seen;
}

absl::StatusOr<QueryView> DecodeView(const v1::MatchView& message, const std::string& field,
                                     const wire::WireLimits& limits) {
  switch (message.content_case()) {
    case v1::MatchView::kFrames: {
      HOMING_ASSIGN_OR_RETURN(const FramePair pair,
                              DecodeFramePair(message.frames(), field + ".frames", limits));
      return QueryView(pair);
    }
    case v1::MatchView::kFlowVectors: {
      HOMING_ASSIGN_OR_RETURN(
          FlowField flow, wire::FromProto(message.flow_vectors(), field + ".flow_vectors", limits));
      return QueryView(std::move(flow));
    }
    case v1::MatchView::kFingerprints:
      return QueryView(DecodeFingerprints(message.fingerprints()));
    case v1::MatchView::CONTENT_NOT_SET:
      break;
  }
  return QueryView();
}

}  // namespace

v1::Journey EncodeJourneyRecord(const storage::JourneyRecord& record) {
  v1::Journey message;
  message.set_name(record.name);
  *message.mutable_settings() = wire::ToProto(record.settings);
  message.set_state(record.state == storage::JourneyState::kFinished ? v1::Journey::STATE_FINISHED
                                                                     : v1::Journey::STATE_ACTIVE);
  message.set_step_count(record.step_count);
  message.set_landmark_count(record.landmark_count);
  message.set_fingerprint_count(record.fingerprint_count);
  message.set_next_sequence(record.next_sequence);
  *message.mutable_create_time() = wire::TimestampToProto(record.create_time_ns);
  if (record.start_time_ns != 0) {
    *message.mutable_start_time() = wire::TimestampToProto(record.start_time_ns);
  }
  if (record.end_time_ns != 0) {
    *message.mutable_end_time() = wire::TimestampToProto(record.end_time_ns);
  }
  message.mutable_readers()->Assign(record.readers.begin(), record.readers.end());
  if (const std::size_t mark = record.writer_id.find('#'); mark != std::string::npos) {
    message.set_source_mark(record.writer_id.substr(mark + 1));
  }
  return message;
}

void EncodeRecordingAnswer(const RecordingAnswer& answer, v1::RecordJourneyResponse* message) {
  message->set_next_sequence(answer.next_sequence);
  if (answer.sequence) {
    message->set_sequence(*answer.sequence);
  }
  message->set_resend_from(answer.resend_from);
  if (answer.frame) {
    message->set_frame(*answer.frame);
  }
  if (answer.is_standing) {
    message->set_motion(v1::MOTION_STANDING);
  }
  if (answer.step) {
    message->set_step(answer.step->step);
    message->set_motion(wire::ToProto(answer.step->motion));
    for (const RecordedFingerprint& f : answer.step->fingerprints) {
      v1::RecordedLandmark* landmark = message->add_landmarks();
      *landmark->mutable_fingerprint() = wire::ToProto(f.side, f.fingerprint);
      landmark->set_spread(f.spread);
    }
  }
}

void EncodeLocalization(const Localization& localization, const LocalizationSession& session,
                        v1::LocalizeResponse* message) {
  message->set_sequence(localization.sequence);
  message->set_frame(localization.frame);
  if (localization.has_flow) {
    message->set_motion(wire::ToProto(localization.motion));
  }
  EncodePosition(localization.position, session, message);
  if (localization.turn) message->set_turn(*localization.turn);
  if (localization.step_sequence) {
    message->set_step_frame(*localization.step_sequence);
  }
  if (localization.landmark) {
    message->set_landmark(*localization.landmark);
  }
  if (localization.similarity) {
    message->set_similarity(*localization.similarity);
  }
  for (const Match& match : localization.matches) {
    EncodeMatch(session.journey_name(match.journey), match, message->add_matches());
  }
}

v1::MatchLandmarksResponse EncodeQueryResult(const LandmarkQueryResult& result) {
  v1::MatchLandmarksResponse message;
  if (result.motion) {
    message.set_motion(wire::ToProto(*result.motion));
  }
  for (const NamedMatch& match : result.matches) {
    EncodeMatch(match.journey, match.match, message.add_matches());
  }
  for (const Side side : {Side::kLeft, Side::kRight}) {
    for (const SeenLandmark& seen : result.seen[static_cast<std::size_t>(side)]) {
      *message.add_seen() = wire::ToProto(side, Fingerprint{seen.x, seen.y, seen.count, 0});
    }
  }
  return message;
}

absl::StatusOr<LocalizationQuery> DecodeLocalizationQuery(const v1::LocalizeConfig& config) {
  LocalizationQuery query;
  query.journey = config.journey();
  HOMING_ASSIGN_OR_RETURN(query.travel, wire::FromProto(config.travel(), "config.travel"));
  HOMING_ASSIGN_OR_RETURN(
      query.cameras[0],
      DecodeCamera(config.has_left_camera(), config.left_camera(), "config.left_camera"));
  HOMING_ASSIGN_OR_RETURN(
      query.cameras[1],
      DecodeCamera(config.has_right_camera(), config.right_camera(), "config.right_camera"));
  query.match =
      DecodeMatchOptions(config.max_matches(), config.has_threshold(), config.threshold());
  if (config.has_tolerance_steps()) {
    query.position.tolerance_steps = config.tolerance_steps();
  }
  if (config.has_match_probability()) {
    query.position.match_probability = config.match_probability();
  }
  if (config.has_unknown_probability()) {
    query.position.unknown_probability = config.unknown_probability();
  }
  query.position.paper_only = config.paper_only();
  if (config.has_prior()) {
    HOMING_ASSIGN_OR_RETURN(query.prior, DecodePrior(config.prior()));
  }
  return query;
}

absl::StatusOr<LandmarkQuery> DecodeLandmarkQuery(const v1::MatchLandmarksRequest& request,
                                                  const wire::WireLimits& limits) {
  LandmarkQuery query;
  query.journey = request.journey();
  HOMING_ASSIGN_OR_RETURN(query.travel, wire::FromProto(request.travel(), "travel"));
  HOMING_ASSIGN_OR_RETURN(query.views[0], DecodeView(request.left(), "left", limits));
  HOMING_ASSIGN_OR_RETURN(query.views[1], DecodeView(request.right(), "right", limits));
  query.match =
      DecodeMatchOptions(request.max_matches(), request.has_threshold(), request.threshold());
  return query;
}

}  // namespace homing::server
