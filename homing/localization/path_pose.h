// Estimates the robot's offset to the left of the outbound path, and its heading relative to the
// path. A turn and an offset move the images alike. The filter separates them, because it estimates
// both together, with a distance for each side of the route.
#ifndef HOMING_LOCALIZATION_PATH_POSE_H_
#define HOMING_LOCALIZATION_PATH_POSE_H_

#include <array>
#include <cstdint>
#include <optional>

#include "homing/flow/camera.h"
#include "homing/flow/observation.h"
#include "homing/journey/journey_map.h"
#include "homing/matching/matcher.h"

namespace homing {

// Both to the robot's left.
struct PathPose {
  // Metres beside the path over the distance of what is seen.
  double offset = 0;
  // Against the outbound path (its other direction for Travel::kReturn), rad.
  double heading = 0;
};

// Two cameras that look across the direction of travel are needed, all the time. Not thread-safe.
class PathPoseFilter {
 public:
  PathPoseFilter(Travel travel, const std::array<Camera, 2>& cameras);

  // An observation; the robot's cameras, as they become known.
  void Begin(const std::array<Camera, 2>& cameras) {
    cameras_ = cameras;
    has_motion_ = false;
  }
  // Of a camera that nothing is known of, with a field of view of 60 degrees. Pixels.
  static double UsualFocal(int width);
  // Starts beside the path.
  void StartAtOffset(double offset);

  // One observation of motion: how the robot has turned beyond what the path needs, read against a
  // step of the map, moves the belief. False: the flow tells nothing.
  bool Predict(const JourneyMap& map, std::int64_t step, const ObservedFlow& flow);
  // Predict was called for this observation, and the flow told something.
  bool has_motion() const { return has_motion_; }
  // A turn on the spot, rad to the left.
  void Turn(double turned);
  // The robot is lost: what was believed says nothing any more.
  void Forget();
  // One observation of motion that cannot be read against the map: the vertical flow turns the
  // heading. False: it shows no turn.
  bool TurnAlone(const ObservedFlow& flow);
  // The flow that a robot would have seen that heads along the path and does not turn.
  ObservedFlow Straighten(const ObservedFlow& flow) const;
  // What the images say, against the steps around `step`. `flow`: as Straighten was given it.
  void Correct(const JourneyMap& map, std::int64_t step, const ObservedFlow& flow);

  // The heading as far as it is known, 0 at first.
  const PathPose& pose() const { return pose_; }
  // The offset is known too.
  bool is_started() const { return is_started_; }
  // The belief's deviations.
  PathPose deviation() const;

 private:
  // Steps advanced, negative towards home, and the path's own turn at each, rad to the left of the
  // outbound robot.
  struct Advance {
    double steps = 0;
    double bend = 0;
  };
  // By side of the route: sideways flow now and at the step, rad.
  Advance AdvanceOf(const std::array<double, 2>& now, const std::array<double, 2>& then,
                    double turn);
  // Pixels.
  double FocalOf(std::size_t camera, int width) const;
  FlowField Turned(const FlowField& field, std::size_t camera, double heading) const;
  // By camera: distances of each tried pose, over the tried steps.
  struct Tried;
  void Fit(const Tried& tried);

  Travel travel_;
  std::array<Camera, 2> cameras_;
  bool is_started_ = false;
  bool has_motion_ = false;
  // Distances of what is seen.
  // Driven since the last correction, and since the place was last lost.
  double uncorrected_ = 0;
  double driven_since_lost_ = 0;
  PathPose pose_;
  // Covariance of offset and heading.
  double offset_variance_;
  double heading_variance_;
  double covariance_ = 0;
  // As it has been lately.
  std::optional<Advance> advance_;
  // Of the last observation: to the left, rad; ahead, distances of what is seen.
  double turned_ = 0;
  double driven_ = 0;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_PATH_POSE_H_
