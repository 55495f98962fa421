// Estimates the robot's offset to the left of the outbound path, and its heading relative to the
// path. A turn and an offset move the images alike. The filter separates them, because it estimates
// both together, with a distance for each side of the route.
#ifndef HOMING_LOCALIZATION_PATH_POSE_H_
#define HOMING_LOCALIZATION_PATH_POSE_H_

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "homing/flow/camera.h"
#include "homing/flow/observation.h"
#include "homing/journey/journey_map.h"
#include "homing/matching/matcher.h"

namespace homing {

// Both to the robot's left.
struct PathPose {
  // Offset in scene distances: metres beside the path divided by the mean distance of the seen
  // objects.
  double offset = 0;
  // Heading relative to the outbound path (its other direction for Travel::kReturn), rad.
  double heading = 0;
};

// It needs two cameras that look across the direction of travel, at every observation. Not
// thread-safe.
class PathPoseFilter {
 public:
  PathPoseFilter(Travel travel, const std::array<Camera, 2>& cameras);

  // Begins an observation. `cameras`: the robot's, with the sizes known so far.
  void Begin(const std::array<Camera, 2>& cameras) {
    cameras_ = cameras;
    has_motion_ = false;
  }
  // Starts beside the path.
  void StartAtOffset(double offset);

  // Predicts the pose for one observation of motion: the turn relative to the path, measured
  // against a step of the map. False: the flow does not show it.
  bool Predict(const JourneyMap& map, std::int64_t step, const ObservedFlow& flow);
  // Predict returned true for this observation.
  bool has_motion() const { return has_motion_; }
  // A turn on the spot, rad to the left.
  void Turn(double turned);
  // Resets the belief, except the heading: the robot is lost.
  void Forget();
  // Predicts the heading for one observation of motion that cannot be compared with the map, by the
  // vertical flow. False: it shows no turn.
  bool TurnAlone(const ObservedFlow& flow);
  // The flow that a robot heading along the path, without turning, would have seen.
  ObservedFlow Straighten(const ObservedFlow& flow) const;
  // Corrects the pose by comparing the images with the steps around `step`, the step of Predict.
  void Correct(const JourneyMap& map, std::int64_t step, const ObservedFlow& flow);

  // The estimated pose; the heading is 0 at first.
  const PathPose& pose() const { return pose_; }
  // True if the offset is known too.
  bool is_started() const { return is_started_; }
  // True once the heading was compared with the map: until then a turn on the spot leaves it 0.
  bool knows_heading() const { return knows_heading_; }
  // Standard deviations of the belief.
  PathPose deviation() const;

 private:
  static std::size_t At(Side side) { return static_cast<std::size_t>(side); }
  // Bounds of the belief: of the offset, and of the heading, rad.
  static constexpr double kMostOffset = 0.6;
  static constexpr double kMostHeading = 0.8;
  // The pose is corrected at once, and then each time that the robot has driven this far: views
  // nearer to each other repeat the same evidence.
  static constexpr double kCorrectionSpacing = 0.10;

  // Steps advanced, negative towards home, and the path's own turn at each, rad to the left of the
  // outbound robot.
  struct Advance {
    double steps = 0;
    double bend = 0;
  };
  // The path's own turn a step around a step, rad to the left, as the way out shows it. Nothing
  // where too few cameras saw it, and of an older map.
  static std::optional<double> StoredBend(const JourneyMap& map, std::int64_t step);
  // `now` and `then` (at the step): sideways flow, rad, by side of the route; `bend`: as
  // StoredBend.
  Advance AdvanceOf(const std::array<double, 2>& now, const std::array<double, 2>& then,
                    double turn, std::optional<double> bend);
  // Focal length of a camera whose images have this width, pixels.
  double FocalOf(std::size_t camera, int width) const;
  FlowField Turned(const FlowField& field, std::size_t camera, double heading) const;
  // Poses around the believed one, and how well the images fit each.
  struct Tried;
  Tried PosesToTry() const;
  // Adds one camera's distances of all poses to the stored profiles.
  void Compare(std::span<const FlowProfile> stored, const FlowField& field, Side camera,
               Tried& tried) const;
  // The posterior's moments over the tried poses.
  void Fit(const Tried& tried);

  Travel travel_;
  std::array<Camera, 2> cameras_;
  bool is_started_ = false;
  bool knows_heading_ = false;
  bool has_motion_ = false;
  // Distance driven since the last correction, and since the robot was lost, scene distances.
  double uncorrected_ = kCorrectionSpacing;
  double driven_since_lost_ = 0;
  PathPose pose_;
  // Covariance of offset and heading.
  double offset_variance_;
  double heading_variance_;
  double covariance_ = 0;
  // Mean of the last observations.
  std::optional<Advance> advance_;
  // Motion of the last observation: turn to the left, rad; distance ahead, scene distances.
  double turned_ = 0;
  double driven_ = 0;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_PATH_POSE_H_
