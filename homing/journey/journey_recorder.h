// BUILD pipeline: observations to steps of a journey, in the paper's order (II-B, III).
#ifndef HOMING_JOURNEY_JOURNEY_RECORDER_H_
#define HOMING_JOURNEY_JOURNEY_RECORDER_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "homing/flow/observation.h"
#include "homing/journey/journey_map.h"
#include "homing/journey/journey_settings.h"
#include "homing/journey/see_landmarks.h"
#include "homing/landmark/landmark_tracker.h"

namespace homing {

// The kind of input of a journey; fixed by its first observation.
enum class InputKind { kUnknown = 0, kFrames = 1, kFlowVectors = 2 };

// "frames", "flow vectors". REQUIRES: known.
const char* NameOf(InputKind kind);

// INVALID_ARGUMENT: frames and flow vectors in one observation, or no camera.
absl::StatusOr<InputKind> InputKindOf(const Observation& observation);

// The state at the end of a journey, from which recording resumes.
struct JourneyTail {
  std::int64_t step_count = 0;
  std::int32_t landmark_count = 0;
  // JourneyStep::sequence of the last step; -1: there is no step.
  std::int64_t last_sequence = -1;
  // The steps from FirstTailStep on, in order; steps without fingerprints may be left out. Only
  // numbers and fingerprints are used.
  std::vector<JourneyStep> steps;
};

// The first step that the tracker still needs after `step_count` steps.
std::int64_t FirstTailStep(const JourneySettings& settings, std::int64_t step_count);

// Records one stream of one journey. Not thread-safe.
class JourneyRecorder {
 public:
  // REQUIRES: Validate(settings).ok().
  explicit JourneyRecorder(const JourneySettings& settings, const DecodeLimits& limits = {});

  // Continues a journey that was recorded before with the same settings.
  void Resume(const JourneyTail& tail);

  // The step that the observation makes. Nothing if it makes none, and for frames up to the last
  // step at Resume, which only rebuild the state. Steps are numbered without gaps.
  // INVALID_ARGUMENT: as InputKindOf and ObservationFlow, a kind unlike the first, flow vectors of
  // a frame that is not after the one of the last step;
  // FAILED_PRECONDITION: image size unlike the journey's camera. After an error the state is as
  // before the call.
  absl::StatusOr<std::optional<JourneyStep>> Record(const Observation& observation);

  // The observation to start with after a restart, so that tracking continues as without one: for
  // frames the reference; for flow vectors the next observation.
  std::int64_t resend_from() const;

  // Image sizes are filled in as they become known.
  const JourneySettings& settings() const { return settings_; }

 private:
  absl::Status CheckKind(InputKind kind) const;
  absl::Status CheckGrows(std::int64_t made_by, InputKind kind) const;
  // Adds the profile and the numbered landmarks of one camera to the step.
  void AddLandmarks(Side side, const SeenStep& seen, JourneyStep& step);

  JourneySettings settings_;
  ObservationFlow flow_;
  LandmarkTracker tracker_;
  InputKind kind_ = InputKind::kUnknown;
  std::int64_t next_step_ = 0;
  // JourneyStep::sequence of the last step; -1: none.
  std::int64_t last_sequence_ = -1;
  std::int64_t next_observation_ = 0;
};

}  // namespace homing

#endif  // HOMING_JOURNEY_JOURNEY_RECORDER_H_
