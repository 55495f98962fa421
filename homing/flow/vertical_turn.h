// Measures the turn by the vertical flow. In cameras that look across, a turn moves points up or
// down; driving along the heading does not.
#ifndef HOMING_FLOW_VERTICAL_TURN_H_
#define HOMING_FLOW_VERTICAL_TURN_H_

#include <array>

#include "homing/flow/camera.h"
#include "homing/flow/observation.h"

namespace homing {

// The turn to the left, rad, and its variance, rad^2: large if the flow does not show a turn.
struct VerticalTurn {
  double turn = 0;
  double variance = 1;
};

// Of one camera; without intrinsics its focal length is UsualFocal.
VerticalTurn ReadVerticalTurn(const FlowField& field, const Camera& camera);
// Of both. A camera without flow does not contribute.
VerticalTurn ReadVerticalTurn(const ObservedFlow& flow, const std::array<Camera, 2>& cameras);

}  // namespace homing

#endif  // HOMING_FLOW_VERTICAL_TURN_H_
