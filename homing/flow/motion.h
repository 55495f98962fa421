// Decides from the flow alone whether the camera stands, turns on the spot or moves. Added to the
// paper.
#ifndef HOMING_FLOW_MOTION_H_
#define HOMING_FLOW_MOTION_H_

#include <array>
#include <cstddef>
#include <optional>

#include "homing/flow/camera.h"
#include "homing/flow/observation.h"

namespace homing {

enum class Motion { kMoving = 1, kStanding = 2, kTurning = 3 };

// Least median length of a camera's flow that makes a step, over the image width: 0.55 px at 370
// px, over three times the flow that noise of 4 of 255 gives a standing camera.
inline constexpr double kStepFraction = 1.5e-3;
// Least number of vectors whose median counts.
inline constexpr std::size_t kMinVectors = 8;

// Whether the median flow length of either camera reaches kStepFraction. Nothing where no camera
// has kMinVectors vectors.
std::optional<bool> HasMoved(const std::array<std::optional<FlowField>, 2>& fields);

// Motion from the rectified fields of both cameras (short vectors included). kStanding exactly
// where the observation makes no step. Only kMoving makes fingerprints. A step with few vectors is
// kMoving. `cameras` give the focal length where known, else a field of view of 60 degrees is
// assumed.
Motion ClassifyMotion(const ObservedFlow& flow, const std::array<Camera, 2>& cameras);

}  // namespace homing

#endif  // HOMING_FLOW_MOTION_H_
