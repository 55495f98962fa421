// Operations on both cameras of the robot.
#ifndef HOMING_JOURNEY_CAMERA_PAIR_H_
#define HOMING_JOURNEY_CAMERA_PAIR_H_

#include <array>

#include "homing/flow/camera.h"
#include "homing/flow/observation.h"

namespace homing {

// The flow that ideal cameras, square to the direction of travel, would have seen.
ObservedFlow Rectify(const ObservedFlow& flow, const std::array<Camera, 2>& cameras);

}  // namespace homing

#endif  // HOMING_JOURNEY_CAMERA_PAIR_H_
