// Drives a simulated robot home by the answers alone: cameras, answers, pilot and wheels in a
// closed loop, in simulated time.
#ifndef CLIENT_DRIVE_HOME_DRIVE_H_
#define CLIENT_DRIVE_HOME_DRIVE_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "client/drive/robot_eyes.h"
#include "client/pilot/pilot.h"
#include "client/simulator/route.h"
#include "client/simulator/wheeled_robot.h"
#include "homing/flow/observation.h"

namespace homing::client {

struct HomeDriveOptions {
  PilotOptions pilot;
  WheeledRobotOptions robot;
  // Frames a second.
  double fps = 10;
  // Number of the first frame; another number gives other noise.
  std::int64_t first_frame = 1'000'000;
  // Start relative to the end of the outbound path: metres beyond it and to its left, and heading,
  // rad to the left.
  double start_ahead_m = 0;
  double start_left_m = 0;
  double start_heading = 0;
  // Delay of the answers, s; the fraction of answers that are lost; and the seed that selects them.
  double delay_s = 0.1;
  double lost = 0;
  std::uint64_t seed = 1;
  // Distance driven, m, after which the link is lost for outage_s seconds: observations are not
  // sent meanwhile. Below 0: never.
  double outage_at_m = -1;
  double outage_s = 0;
  // Distance driven, m, after which the robot is carried along the path towards home, by carried_m.
  // Below 0: never.
  double carried_at_m = -1;
  double carried_m = 0;
  // The pilot gets usual values instead of turn, offset and speed.
  bool blindfolded = false;
  // Gives up after this time, s.
  double most_s = 600;
};

struct DrivenPoint {
  double time_s = 0;
  Pose pose;
  // Along the outbound path from home, and to the left of it as the outbound robot has it.
  double route_m = 0;
  double left_m = 0;
  // The robot's heading relative to its way along the path, rad to its left.
  double heading = 0;
  Pilot::State state = Pilot::State::kDriving;
  PilotCommand command;
  // The pilot's belief: metres left of the path, and heading relative to it, rad; m from home.
  double believed_left_m = 0;
  double believed_heading = 0;
  double believed_home_m = 0;
  // The answer to the observation made here, if one was sent.
  std::optional<PilotAnswer> answer;
};

struct HomeDrive {
  std::vector<DrivenPoint> points;
  // The pilot stopped because it believed to be at home.
  bool stopped = false;

  // Final distance from home, m.
  double EndFromHome(const Route& route) const;
};

// Answers one observation, numbered from 0 without gaps; the caller sets `time_s` by the robot's
// clock.
using Answering = std::function<absl::StatusOr<PilotAnswer>(const Observation&)>;
// Called at the outage: the link breaks.
using OnOutage = std::function<absl::Status()>;

// Drives home. Errors of `answering`. The outbound path is the route from 0 to pilot.route_m.
absl::StatusOr<HomeDrive> DriveHome(const HomeDriveOptions& options, const Route& route,
                                    RobotEyes* eyes, const Answering& answering,
                                    const OnOutage& on_outage = {});

}  // namespace homing::client

#endif  // CLIENT_DRIVE_HOME_DRIVE_H_
