// What a program on a robot has of itself. To be filled in for yours.
#ifndef EXAMPLES_ROBOT_H_
#define EXAMPLES_ROBOT_H_

#include <optional>

#include "homing/v1/types.pb.h"

namespace robot {

// With focal lengths, so that turns come in radians.
homing::v1::Camera LeftCamera();
homing::v1::Camera RightCamera();
// Both cameras' frames of one instant; nothing if none is new.
std::optional<homing::v1::Observation> NextFrames();
// Seconds.
double Now();
// Speed ahead, m/s, and turn rate to the left, rad/s; waits a twentieth of a second. Stops for
// obstacles.
void Drive(double speed_mps, double turn_rate);

}  // namespace robot

#endif  // EXAMPLES_ROBOT_H_
