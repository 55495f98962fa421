// Converts between the installed headers' types and messages.
#ifndef CLIENT_ROBOT_CONVERSION_H_
#define CLIENT_ROBOT_CONVERSION_H_

#include "absl/status/status.h"
#include "client/connection.h"
#include "homing/client/localizer.h"
#include "homing/client/observation.h"
#include "homing/client/recorder.h"
#include "homing/client/server.h"
#include "homing/client/status.h"
#include "homing/v1/homing_service.pb.h"
#include "homing/v1/journey_service.pb.h"
#include "homing/v1/types.pb.h"

namespace homing::robot {

Status FromAbsl(const absl::Status& status);
client::ConnectionOptions ToConnection(const Server& server);
v1::Observation ToMessage(const Observation& observation);
v1::Camera ToMessage(const Camera& camera);
v1::LocalizeConfig ToMessage(const LocalizerOptions& options);
Recorded FromMessage(const v1::RecordJourneyResponse& answer);
Answer FromMessage(const v1::LocalizeResponse& answer);

}  // namespace homing::robot

#endif  // CLIENT_ROBOT_CONVERSION_H_
