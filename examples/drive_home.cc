// A robot drives home: frames to the server, its answers to the pilot, the pilot's commands to the
// wheels. What is the robot's own (see robot.h) is left to it: cameras, clock, wheels, obstacles.
#include <map>

#include "client/live_localizer.h"
#include "client/pilot_answer.h"
#include "robot.h"

using namespace homing::client;

int main() {
  ConnectionOptions server;
  server.address = "base:50551";
  auto connection = Connection::Open(server);
  if (!connection.ok()) return 1;
  LocalizingOptions options;
  options.config.set_journey("robots/r1/journeys/monday");
  options.config.set_travel(homing::v1::TRAVEL_RETURN);
  *options.config.mutable_left_camera() = robot::LeftCamera();
  *options.config.mutable_right_camera() = robot::RightCamera();
  LiveLocalizer localizer(&*connection, options);
  PilotOptions limits;
  limits.route_m = 60;
  limits.most_speed_mps = 0.8;
  Pilot pilot(limits);
  std::map<std::int64_t, double> seen_s;
  while (pilot.state() != Pilot::State::kHome) {
    if (auto frames = robot::NextFrames()) {
      const double now_s = robot::Now();
      seen_s[localizer.Send(*std::move(frames))] = now_s;
    }
    auto answer = localizer.Poll();
    if (!answer.ok()) break;
    if (*answer) pilot.Take(ToPilotAnswer(**answer, seen_s[(*answer)->sequence()]));
    const PilotCommand command = pilot.Drive(robot::Now());
    robot::Drive(command.speed_mps, command.turn_rate);
  }
  robot::Drive(0, 0);
}
