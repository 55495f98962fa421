#include "client/robot/conversion.h"

#include <google/protobuf/util/time_util.h>

namespace homing::robot {
namespace {

v1::FrameEncoding ToMessage(Encoding encoding) {
  switch (encoding) {
    case Encoding::kGray8:
      return v1::FRAME_ENCODING_GRAY8;
    case Encoding::kRgb8:
      return v1::FRAME_ENCODING_RGB8;
    case Encoding::kBgr8:
      return v1::FRAME_ENCODING_BGR8;
    case Encoding::kJpeg:
      return v1::FRAME_ENCODING_JPEG;
    case Encoding::kPng:
      return v1::FRAME_ENCODING_PNG;
  }
  return v1::FRAME_ENCODING_UNSPECIFIED;
}

void Fill(const View& view, v1::CameraView* message) {
  if (view.image) {
    v1::Frame& frame = *message->mutable_frame();
    frame.set_encoding(ToMessage(view.image->encoding));
    frame.set_width(view.image->width);
    frame.set_height(view.image->height);
    frame.set_data(view.image->data, view.image->size);
  } else if (view.flow) {
    v1::FlowVectors& flow = *message->mutable_flow_vectors();
    flow.set_width(view.flow->width);
    flow.set_height(view.flow->height);
    for (const FlowVector& vector : view.flow->vectors) {
      flow.add_start_x(vector.start_x);
      flow.add_start_y(vector.start_y);
      flow.add_end_x(vector.end_x);
      flow.add_end_y(vector.end_y);
    }
  }
}

// The numbers of both enumerations are the same.
Motion FromMessage(v1::Motion motion) { return static_cast<Motion>(motion); }
Side FromMessage(v1::Side side) { return static_cast<Side>(side); }

Outcome FromMessage(v1::Outcome outcome) {
  if (outcome == v1::OUTCOME_MATCH) return Outcome::kMatch;
  return outcome == v1::OUTCOME_AMBIGUOUS ? Outcome::kAmbiguous : Outcome::kUnknownPlace;
}

Direction FromMessage(v1::Direction direction) {
  if (direction == v1::DIRECTION_HOMEWARD) return Direction::kHomeward;
  return direction == v1::DIRECTION_OUTWARD ? Direction::kOutward : Direction::kUnknown;
}

Match FromMessage(const v1::Match& match) {
  return {match.journey(), match.landmark(), match.step(), FromMessage(match.side()),
          match.delta(),   match.p(),        match.p_t()};
}

}  // namespace

Status FromAbsl(const absl::Status& status) {
  if (status.ok()) return {};
  return {static_cast<Code>(status.raw_code()), std::string(status.message())};
}

client::ConnectionOptions ToConnection(const Server& server) {
  client::ConnectionOptions options;
  options.address = server.address;
  options.tls_ca = server.tls_ca;
  options.tls_cert = server.tls_cert;
  options.tls_key = server.tls_key;
  options.token_file = server.token_file;
  options.insecure = server.insecure;
  // A robot has no operator at hand: it retries as long as its program runs.
  options.retry_for = std::chrono::hours(24 * 365);
  return options;
}

v1::Observation ToMessage(const Observation& observation) {
  v1::Observation message;
  if (observation.left) Fill(*observation.left, message.mutable_left());
  if (observation.right) Fill(*observation.right, message.mutable_right());
  if (observation.capture_time_ns != 0) {
    *message.mutable_capture_time() =
        google::protobuf::util::TimeUtil::NanosecondsToTimestamp(observation.capture_time_ns);
  }
  message.set_break_before(observation.break_before);
  return message;
}

v1::Camera ToMessage(const Camera& camera) {
  v1::Camera message;
  message.set_focal_x(camera.focal_x);
  message.set_focal_y(camera.focal_y);
  message.set_center_x(camera.center_x);
  message.set_center_y(camera.center_y);
  for (const double coefficient : camera.distortion) message.add_distortion(coefficient);
  message.set_fisheye(camera.fisheye);
  message.set_yaw_rad(camera.yaw_rad);
  return message;
}

v1::LocalizeConfig ToMessage(const LocalizerOptions& options) {
  v1::LocalizeConfig config;
  config.set_journey(options.journey);
  config.set_travel(options.travel == Travel::kSame ? v1::TRAVEL_SAME : v1::TRAVEL_RETURN);
  if (options.left_camera) *config.mutable_left_camera() = ToMessage(*options.left_camera);
  if (options.right_camera) *config.mutable_right_camera() = ToMessage(*options.right_camera);
  config.set_max_matches(options.max_matches);
  config.set_threshold(options.threshold);
  config.set_tolerance_steps(options.tolerance_steps);
  return config;
}

Recorded FromMessage(const v1::RecordJourneyResponse& answer) {
  Recorded recorded;
  recorded.sequence = answer.sequence();
  if (answer.has_step()) recorded.step = answer.step();
  recorded.motion = FromMessage(answer.motion());
  recorded.landmarks = answer.landmarks_size();
  return recorded;
}

Answer FromMessage(const v1::LocalizeResponse& message) {
  Answer answer;
  answer.sequence = message.sequence();
  answer.outcome = FromMessage(message.outcome());
  answer.motion = FromMessage(message.motion());
  if (!message.journey().empty()) answer.journey = message.journey();
  if (message.has_step()) answer.step = message.step();
  answer.probability = message.probability();
  answer.first_step = message.interval().first();
  answer.last_step = message.interval().last();
  if (message.has_progress_home()) answer.progress_home = message.progress_home();
  answer.direction = FromMessage(message.direction());
  if (message.has_landmark()) answer.landmark = message.landmark();
  if (message.has_similarity()) answer.similarity = message.similarity();
  if (message.has_speed_ratio()) answer.speed_ratio = message.speed_ratio();
  if (message.has_turn()) answer.turn = message.turn();
  if (message.has_path_offset()) answer.path_offset = message.path_offset();
  answer.on_route = message.on_route();
  for (const v1::Match& match : message.matches()) answer.matches.push_back(FromMessage(match));
  return answer;
}

}  // namespace homing::robot
