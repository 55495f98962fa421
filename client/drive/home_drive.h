// A simulated robot drives home by the answers alone: cameras, answers, pilot, wheels, in a closed
// loop in simulated time.
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
  // Number of the first frame: another one has other noise.
  std::int64_t first_frame = 1'000'000;
  // Where it starts against the end of the outbound path: metres beyond it and to its left, rad to
  // the left.
  double start_ahead_m = 0;
  double start_left_m = 0;
  double start_heading = 0;
  // Answers come so late, and this share of them not at all; the seed of which.
  double delay_s = 0.1;
  double lost = 0;
  std::uint64_t seed = 1;
  // From this way driven on nothing is answered for so many seconds: what is seen meanwhile is not
  // sent. Below 0: never.
  double outage_at_m = -1;
  double outage_s = 0;
  // From this way driven on the robot is carried along the path, towards home. Below 0: never.
  double carried_at_m = -1;
  double carried_m = 0;
  // The pilot is given what is usual instead of turn, offset and speed.
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
  // Of the robot to its left, against its way along the path; rad.
  double heading = 0;
  Pilot::State state = Pilot::State::kDriving;
  PilotCommand command;
  // To what it saw here, if it was asked.
  std::optional<PilotAnswer> answer;
};

struct HomeDrive {
  std::vector<DrivenPoint> points;
  // The pilot stopped at what it took for home.
  bool stopped = false;

  // Where it ended, m from home.
  double EndFromHome(const Route& route) const;
};

// Answers one observation, numbered from 0 without gaps; `time_s` of the robot's clock is the
// caller's to fill in.
using Answering = std::function<absl::StatusOr<PilotAnswer>(const Observation&)>;
// Called at the outage: the link breaks.
using OnOutage = std::function<absl::Status()>;

// As `answering`. The outbound path is the route from 0 to pilot.route_m.
absl::StatusOr<HomeDrive> DriveHome(const HomeDriveOptions& options, const Route& route,
                                    RobotEyes* eyes, const Answering& answering,
                                    const OnOutage& on_outage = {});

}  // namespace homing::client

#endif  // CLIENT_DRIVE_HOME_DRIVE_H_
