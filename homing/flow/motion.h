// Standing, turning on the spot, or moving: told from the flow alone. Source: own design (METHOD
// 1).
#ifndef HOMING_FLOW_MOTION_H_
#define HOMING_FLOW_MOTION_H_

#include "homing/flow/camera.h"
#include "homing/flow/observation.h"

namespace homing {

enum class Motion { kMoving = 1, kStanding = 2, kTurning = 3 };

// Of one step, from the rectified fields of both cameras (short vectors included). Only kMoving
// makes fingerprints. With no vectors at all: kMoving (a blank wall tells nothing). `cameras` give
// the focal length where known, else a field of view of 60 degrees is assumed.
Motion ClassifyMotion(const ObservedFlow& flow, const std::array<Camera, 2>& cameras);

}  // namespace homing

#endif  // HOMING_FLOW_MOTION_H_
