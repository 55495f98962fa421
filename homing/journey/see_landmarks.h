// Flow of both cameras to the landmarks seen: the one way in which recording, localisation and a
// single query look at an observation. Source: paper II-B, III, Fig. 4; eqs 11, 12.
#ifndef HOMING_JOURNEY_SEE_LANDMARKS_H_
#define HOMING_JOURNEY_SEE_LANDMARKS_H_

#include <array>
#include <vector>

#include "homing/flow/motion.h"
#include "homing/flow/observation.h"
#include "homing/landmark/fingerprint.h"
#include "homing/landmark/landmark_finder.h"

namespace homing {

// kReturn: the cameras look at exchanged sides of the route. The direction is always estimated.
enum class Travel { kReturn = 1, kSame = 2 };

// The side of the route that a camera of the robot looks at.
Side RouteSide(Side camera, Travel travel);

// Landmarks seen at one instant, indexed by side of the ROUTE.
using SeenSides = std::array<std::vector<SeenLandmark>, 2>;

struct SeenStep {
  // The flow that ideal cameras, square to the direction of travel, would see; indexed by Side of
  // the ROBOT.
  ObservedFlow flow;
  Motion motion = Motion::kMoving;
  // At most two a camera; none unless the robot is kMoving.
  SeenSides landmarks;
};

// `raw` and `cameras` are indexed by Side of the ROBOT. REQUIRES: Validate(options).ok(), and each
// camera with a field has its image size.
SeenStep SeeLandmarks(const ObservedFlow& raw, const std::array<Camera, 2>& cameras, Travel travel,
                      const LandmarkOptions& options);

}  // namespace homing

#endif  // HOMING_JOURNEY_SEE_LANDMARKS_H_
