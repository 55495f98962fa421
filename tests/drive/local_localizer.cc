#include "tests/drive/local_localizer.h"

#include "client/simulator/simulator.h"
#include "homing/base/status_macros.h"
#include "homing/journey/journey_recorder.h"

namespace homing::drive {
namespace {

using client::PilotAnswer;
using client::Simulator;

Camera SimulatedCamera() {
  return {.width = Simulator::kWidth,
          .height = Simulator::kHeight,
          .intrinsics = Intrinsics{Simulator::kFocal, Simulator::kFocal, Simulator::kCenterX,
                                   Simulator::kCenterY}};
}

PilotAnswer::Outcome OutcomeOf(Outcome outcome) {
  switch (outcome) {
    case Outcome::kMatch:
      return PilotAnswer::Outcome::kMatch;
    case Outcome::kUnknownPlace:
      return PilotAnswer::Outcome::kUnknownPlace;
    case Outcome::kAmbiguous:
      break;
  }
  return PilotAnswer::Outcome::kAmbiguous;
}

PilotAnswer AnswerOf(const Localization& localization) {
  const Position& position = localization.position;
  PilotAnswer answer;
  answer.outcome = OutcomeOf(position.outcome);
  answer.is_turning = localization.motion == Motion::kTurning;
  answer.is_standing = localization.motion == Motion::kStanding;
  answer.probability = position.probability;
  if (position.step) answer.progress_home = position.progress_home;
  answer.speed_ratio = position.speed_ratio;
  answer.turn = localization.turn;
  answer.path_offset = position.path_offset;
  return answer;
}

}  // namespace

absl::StatusOr<JourneyMap> RecordOut(const client::Route& route, const OutboundDrive& drive,
                                     client::RobotEyes* eyes) {
  JourneySettings settings;
  settings.cameras = {SimulatedCamera(), SimulatedCamera()};
  JourneyRecorder recorder(settings);
  JourneyMap map(settings);
  const double frame_m = drive.speed_mps / drive.fps;
  const auto frames = static_cast<std::int64_t>(drive.length_m / frame_m + 1e-6) + 1;
  for (std::int64_t frame = 0; frame < frames; ++frame) {
    Observation seen = eyes->See(route.At(frame_m * static_cast<double>(frame)), frame);
    seen.sequence = frame;
    HOMING_ASSIGN_OR_RETURN(const auto step, recorder.Record(seen));
    if (step) HOMING_RETURN_IF_ERROR(map.Append(*step));
  }
  return map;
}

LocalLocalizer::LocalLocalizer(const JourneyMap* map, Travel travel)
    : journey_{&name_, map},
      travel_(travel),
      localizer_(Fresh()),
      prior_{.journey = 0,
             .step = std::max<std::int64_t>(0, map->step_count() - 1),
             .direction = Direction::kHomeward,
             .probability = 0.95,
             .path_offset = {}} {
  // An empty map needs no prior.
  localizer_.Start({&journey_, 1}, prior_).IgnoreError();
}

Localizer LocalLocalizer::Fresh() const {
  LocalizerOptions options;
  options.travel = travel_;
  options.cameras = {SimulatedCamera(), SimulatedCamera()};
  return Localizer(options);
}

absl::StatusOr<PilotAnswer> LocalLocalizer::Answer(const Observation& seen) {
  kept_.push_back({seen, prior_});
  if (kept_.size() > kReplay) kept_.pop_front();
  HOMING_ASSIGN_OR_RETURN(const Localization answer, localizer_.Localize(seen, {&journey_, 1}));
  if (answer.position.step) {
    prior_ = {.journey = 0,
              .step = *answer.position.step,
              .direction = answer.position.direction,
              .probability = answer.position.probability,
              .path_offset = answer.position.path_offset};
  }
  return AnswerOf(answer);
}

absl::Status LocalLocalizer::Restart() {
  localizer_ = Fresh();
  if (kept_.empty()) return absl::OkStatus();
  HOMING_RETURN_IF_ERROR(localizer_.Start({&journey_, 1}, kept_.front().prior));
  for (const Kept& kept : kept_) {
    HOMING_RETURN_IF_ERROR(localizer_.Localize(kept.observation, {&journey_, 1}).status());
  }
  return absl::OkStatus();
}

}  // namespace homing::drive
