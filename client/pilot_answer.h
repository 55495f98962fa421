// Converts an answer of Localize for the pilot.
#ifndef CLIENT_PILOT_ANSWER_H_
#define CLIENT_PILOT_ANSWER_H_

#include "client/pilot/pilot.h"
#include "homing/v1/homing_service.pb.h"

namespace homing::client {

// `time_s`: when the observation was made, by the robot's clock. The camera must have been given
// with its focal length, else a turn is in pixels.
PilotAnswer ToPilotAnswer(const v1::LocalizeResponse& answer, double time_s);

}  // namespace homing::client

#endif  // CLIENT_PILOT_ANSWER_H_
