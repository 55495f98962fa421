#include "homing/journey/journey_recorder.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"
#include "homing/flow/vertical_turn.h"

namespace homing {
namespace {

// A turn that is less sure is not stored, rad squared.
constexpr double kMostTurnVariance = 0.01 * 0.01;

InputKind KindOf(const CameraView& view) {
  if (std::holds_alternative<Frame>(view)) {
    return InputKind::kFrames;
  }
  return std::holds_alternative<FlowField>(view) ? InputKind::kFlowVectors : InputKind::kUnknown;
}

// JourneyStep::sequence of the step that the observation may make.
std::int64_t FrameOf(const Observation& observation, InputKind kind) {
  return kind == InputKind::kFlowVectors ? observation.frame.value_or(observation.sequence)
                                         : observation.sequence;
}

}  // namespace

const char* NameOf(InputKind kind) {
  return kind == InputKind::kFrames ? "frames" : "flow vectors";
}

absl::StatusOr<InputKind> InputKindOf(const Observation& observation) {
  const InputKind left = KindOf(observation.views[0]);
  const InputKind right = KindOf(observation.views[1]);
  if (left == InputKind::kUnknown && right == InputKind::kUnknown) {
    return NoCameraError();
  }
  if (left != InputKind::kUnknown && right != InputKind::kUnknown && left != right) {
    return FieldError("right", "must be frames or flow vectors, as left is");
  }
  return std::max(left, right);
}

std::int64_t FirstTailStep(const JourneySettings& settings, std::int64_t step_count) {
  return std::max<std::int64_t>(0, step_count - settings.landmark.max_track_gap_steps - 1);
}

JourneyRecorder::JourneyRecorder(const JourneySettings& settings, const DecodeLimits& limits)
    : settings_(settings), flow_(settings.flow, limits), tracker_(settings.landmark) {}

void JourneyRecorder::Resume(const JourneyTail& tail) {
  next_step_ = tail.step_count;
  last_sequence_ = tail.last_sequence;
  tracker_ = LandmarkTracker(settings_.landmark);
  for (const JourneyStep& step : tail.steps) {
    for (const RecordedFingerprint& recorded : step.fingerprints) {
      tracker_.Restore(step.step, recorded.side, recorded.fingerprint);
    }
  }
  tracker_.set_landmark_count(tail.landmark_count);
}

absl::Status JourneyRecorder::CheckKind(InputKind kind) const {
  if (kind_ == InputKind::kUnknown || kind_ == kind) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat(NameOf(kind), " must be ", NameOf(kind_), ", as before"));
}

// Frames up to the last step rebuild state; flow vectors have none to rebuild.
absl::Status JourneyRecorder::CheckGrows(std::int64_t made_by, InputKind kind) const {
  if (kind == InputKind::kFrames || made_by > last_sequence_) {
    return absl::OkStatus();
  }
  return MustBe("frame", made_by, absl::StrCat("over ", last_sequence_, ", that of the last step"));
}

std::int64_t JourneyRecorder::resend_from() const {
  return kind_ == InputKind::kFrames ? flow_.reference_sequence() : next_observation_;
}

absl::StatusOr<std::optional<JourneyStep>> JourneyRecorder::Record(const Observation& observation) {
  HOMING_ASSIGN_OR_RETURN(const InputKind kind, InputKindOf(observation));
  HOMING_RETURN_IF_ERROR(CheckKind(kind));
  const std::int64_t made_by = FrameOf(observation, kind);
  HOMING_RETURN_IF_ERROR(CheckGrows(made_by, kind));
  // II-B, equations (1) to (5): corners, and their flow since the reference frame.
  HOMING_ASSIGN_OR_RETURN(const ObservedFlow flow, flow_.Compute(observation, settings_.cameras));
  flow_.FillSizes(settings_.cameras);
  kind_ = kind;
  next_observation_ = observation.sequence + 1;
  if (!flow.makes_step || made_by <= last_sequence_) {
    return std::nullopt;
  }
  // III, Fig. 4, equations (11), (12): landmarks. A recording defines the sides of its route.
  const SeenStep seen = SeeLandmarks(flow, settings_.cameras, Travel::kSame, settings_.landmark);
  JourneyStep step{.step = next_step_,
                   .motion = seen.motion,
                   .fingerprints = {},
                   .profiles = {},
                   .sequence = made_by};
  if (step.motion == Motion::kMoving) {
    for (const Side side : {Side::kLeft, Side::kRight}) {
      AddLandmarks(side, seen, step);
    }
  }
  ++next_step_;
  last_sequence_ = made_by;
  return step;
}

void JourneyRecorder::AddLandmarks(Side side, const SeenStep& seen, JourneyStep& step) {
  const auto index = static_cast<std::size_t>(side);
  const std::optional<FlowField>& field = seen.flow.fields[index];
  if (!field) {
    return;
  }
  // Added to the paper: where the vectors are, and how far away.
  FlowProfile profile = MakeFlowProfile(*field);
  // Added to the paper: how the path bends here, as one camera sees it alone.
  const VerticalTurn bend = ReadVerticalTurn(*field, settings_.cameras[index]);
  if (profile.odometer.has_value() && bend.variance < kMostTurnVariance) {
    profile.odometer.turn_code = OdometerReading::TurnCode(bend.turn);
  }
  step.profiles[index] = profile;
  // III: numbered along the journey.
  const std::vector<SeenLandmark>& landmarks = seen.landmarks[index];
  const std::vector<Fingerprint> numbered = tracker_.Associate(step.step, side, landmarks);
  for (std::size_t i = 0; i < numbered.size(); ++i) {
    step.fingerprints.push_back({side, numbered[i], landmarks[i].spread});
  }
}

}  // namespace homing
