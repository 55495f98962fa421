// One instant of the robot as it comes in: frames or flow vectors of either camera or both.
#ifndef HOMING_FLOW_OBSERVATION_H_
#define HOMING_FLOW_OBSERVATION_H_

#include <array>
#include <cstdint>
#include <optional>
#include <variant>

#include "absl/status/statusor.h"
#include "homing/flow/camera.h"
#include "homing/flow/flow_tracker.h"
#include "homing/flow/flow_vector.h"
#include "homing/image/frame.h"

namespace homing {

// A camera of the robot, or a side of the route as the outbound robot met it.
enum class Side { kLeft = 0, kRight = 1 };

// What one camera gave: nothing, a frame, or the flow from an earlier frame to this one.
using CameraView = std::variant<std::monostate, Frame, FlowField>;

struct Observation {
  // From 0, without gaps.
  std::int64_t sequence = 0;
  // Robot's clock, nanoseconds since the epoch; 0: not given.
  std::int64_t capture_time_ns = 0;
  // No step spans the point before this observation.
  bool break_before = false;
  // Indexed by Side: the ROBOT's cameras.
  std::array<CameraView, 2> views;
  // Index of the frame in the robot's source, if it is not `sequence`: flow vectors are sent only
  // for frames that make a step.
  std::optional<std::int64_t> frame = std::nullopt;
};

// Raw flow of both cameras from their reference frames to one instant; empty where there is none
// (camera absent now or in the reference, first frame, break).
struct ObservedFlow {
  std::array<std::optional<FlowField>, 2> fields;
  // The flow is measurable, or tracking was lost: the frames become the reference.
  bool makes_step = false;
};

// Most vectors of one camera at one instant.
inline constexpr std::size_t kMaxFlowVectors = 100'000;

// Observations of one stream to raw flow: decodes and tracks frames, passes flow vectors on. Used
// by the server and on the robot alike. Both cameras share one reference: the observation that made
// the last step. Each frame is tracked from its camera's reference frame, so that slow robots, fast
// cameras and repeated frames make the steps that others make. Not thread-safe.
class ObservationFlow {
 public:
  // REQUIRES: Validate(options).ok().
  explicit ObservationFlow(const FlowOptions& options, const DecodeLimits& limits = {});

  // INVALID_ARGUMENT: undecodable frame, changed size, a vector that is not finite or over one
  // image size outside its image, over kMaxFlowVectors, no camera at all. After an error the state
  // is as before the call. CANCELLED: the limits' cancellation; the object must not be used any
  // more. A camera that is absent at a step gives no flow until the next step.
  absl::StatusOr<ObservedFlow> Compute(const Observation& observation);
  // The same for views that must have their camera's size where that is known. Besides:
  // FAILED_PRECONDITION where they have not.
  absl::StatusOr<ObservedFlow> Compute(const Observation& observation,
                                       const std::array<Camera, 2>& cameras);

  // Gives cameras of unknown size that of their images so far.
  void FillSizes(std::array<Camera, 2>& cameras) const;

  // The observation whose frames are the reference; 0 before the first frame.
  std::int64_t reference_sequence() const { return reference_sequence_; }

 private:
  // A view that nothing is wrong with. Empty `gray` unless it was a frame; 0 x 0 if absent.
  struct CheckedView {
    cv::Mat gray;
    cv::Size size;
  };
  absl::StatusOr<CheckedView> Check(const CameraView& view, std::size_t side) const;
  using CheckedViews = std::array<CheckedView, 2>;
  void ForgetReference();
  absl::StatusOr<ObservedFlow> TrackFrames(const CheckedViews& checked);
  // Makes the current frames the reference; a camera without one has no reference then.
  void Advance(const CheckedViews& checked);

  FlowOptions options_;
  DecodeLimits limits_;
  // Made for a camera's first frame: many robots send flow vectors alone.
  std::array<std::optional<FlowTracker>, 2> trackers_;
  // Of the cameras' images so far; 0 x 0: none yet.
  std::array<cv::Size, 2> sizes_;
  std::int64_t reference_sequence_ = 0;
};

}  // namespace homing

#endif  // HOMING_FLOW_OBSERVATION_H_
