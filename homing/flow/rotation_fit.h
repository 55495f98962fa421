// Fits a rigid rotation to the flow. The flow of a turning camera does not depend on distance, so
// three numbers explain all of it.
#ifndef HOMING_FLOW_ROTATION_FIT_H_
#define HOMING_FLOW_ROTATION_FIT_H_

#include "homing/flow/camera.h"
#include "homing/flow/flow_vector.h"

namespace homing {

// Robust fit of a rotation to one camera's vectors.
struct RotationFit {
  // Pan in radians a step, positive if the image moves to higher x; from both flow components.
  double pan = 0;
  // Pan from the vertical components alone, and its standard error: a turn shows in them, sideways
  // motion does not. Both are 0 when the rotation explains less than half of the vectors.
  double vertical_pan = 0;
  double vertical_pan_error = 0;
  // Fraction of the vectors that the rotation explains. [0, 1].
  double explained = 0;
  // Median residual and median flow length of the vectors, pixels.
  double median_residual = 0;
  double median_length = 0;
};

// REQUIRES: at least 3 vectors. Without intrinsics a field of view of 60 degrees is assumed.
RotationFit FitRotation(const FlowField& field, const Camera& camera);

}  // namespace homing

#endif  // HOMING_FLOW_ROTATION_FIT_H_
