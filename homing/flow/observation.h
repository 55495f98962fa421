// One instant of the robot's input: frames or flow vectors of either camera or both.
#ifndef HOMING_FLOW_OBSERVATION_H_
#define HOMING_FLOW_OBSERVATION_H_

#include <array>
#include <cstdint>
#include <optional>
#include <variant>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/flow/camera.h"
#include "homing/flow/flow_tracker.h"
#include "homing/flow/flow_vector.h"
#include "homing/image/frame.h"

namespace homing {

// A camera of the robot, or a side of the route as the outbound robot met it.
enum class Side { kLeft = 0, kRight = 1 };

// Names of the cameras, indexed by Side.
inline constexpr std::array<const char*, 2> kCameraNames = {"left", "right"};

// The input of one camera: nothing, a frame, or the flow from an earlier frame to this one.
using CameraView = std::variant<std::monostate, Frame, FlowField>;

// The largest sequence: the numbers after it do not overflow.
inline constexpr std::int64_t kMostSequence = std::int64_t{1} << 62;

// INVALID_ARGUMENT: an observation or a query without a camera.
absl::Status NoCameraError();

struct Observation {
  // From 0 to kMostSequence, without gaps.
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

// Turns the observations of one stream into raw flow: decodes and tracks frames, passes flow
// vectors on. The server and the robot use the same code. Both cameras share one reference: the
// observation that made the last step. Each frame is tracked from its camera's reference frame, so
// that slow robots, fast cameras and repeated frames make the same steps. Not thread-safe.
class ObservationFlow {
 public:
  // REQUIRES: Validate(options).ok().
  explicit ObservationFlow(const FlowOptions& options, const DecodeLimits& limits = {});

  // INVALID_ARGUMENT: undecodable frame, changed size, a vector that is not finite or over one
  // image size outside its image, over kMaxFlowVectors, no camera at all. After an error the state
  // is as before the call. CANCELLED: the limits' cancellation; the object must not be used any
  // more. A camera that is absent at a step gives no flow until the next step.
  absl::StatusOr<ObservedFlow> Compute(const Observation& observation);
  // As above. Also FAILED_PRECONDITION if a view differs from the known size of its camera.
  absl::StatusOr<ObservedFlow> Compute(const Observation& observation,
                                       const std::array<Camera, 2>& cameras);

  // Sets the size of cameras without one, from their images so far.
  void FillSizes(std::array<Camera, 2>& cameras) const;

  // The observation whose frames are the reference; 0 before the first frame.
  std::int64_t reference_sequence() const { return reference_sequence_; }

 private:
  // A valid view. Empty `gray` unless it was a frame; 0 x 0 if absent.
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
  // Created at a camera's first frame: many robots send flow vectors only.
  std::array<std::optional<FlowTracker>, 2> trackers_;
  // Size of each camera's images so far; 0 x 0: no image yet.
  std::array<cv::Size, 2> sizes_;
  std::int64_t reference_sequence_ = 0;
};

}  // namespace homing

#endif  // HOMING_FLOW_OBSERVATION_H_
