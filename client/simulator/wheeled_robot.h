// A robot on two driven wheels: it follows commands late, slips, and deviates from its commands.
#ifndef CLIENT_SIMULATOR_WHEELED_ROBOT_H_
#define CLIENT_SIMULATOR_WHEELED_ROBOT_H_

#include <array>
#include <cstdint>

#include "client/simulator/geometry.h"

namespace homing::client {

struct WheeledRobotOptions {
  // Time constant of the actuators, s. [0, 2].
  double lag_s = 0.2;
  // Greatest slip of a wheel, as a fraction of its motion. Each wheel's slip varies independently.
  // [0, 1).
  double slip = 0.2;
  // Deviation of speed and turn rate from the command, as a fraction of it, changing kNoiseHz times
  // a second. [0, 1].
  double noise = 0.05;
  // Distance between the wheels, m. Above 0.
  double track_m = 0.6;
  std::uint64_t seed = 1;

  static constexpr double kNoiseHz = 10;
};

// Its pose's heading is where it heads. The same seed and commands give the same path. Not
// thread-safe.
class WheeledRobot {
 public:
  WheeledRobot(const WheeledRobotOptions& options, const Pose& start);

  // Speed ahead, m/s, and turn rate to the left, rad/s.
  struct Command {
    double speed_mps = 0;
    double turn_rate = 0;
  };
  // Drives on under one command for a time.
  void Drive(const Command& command, double seconds);
  // Sets the robot down elsewhere.
  void SetDown(const Pose& pose) { pose_ = pose; }

  const Pose& pose() const { return pose_; }
  // The actuators' present motion.
  const Command& motion() const { return motion_; }
  double time_s() const { return static_cast<double>(ticks_) * kTickS; }

 private:
  static constexpr double kTickS = 0.01;

  void Tick(const Command& command);
  // Present slip of a wheel, a fraction of its motion.
  double SlipOf(std::size_t wheel) const;

  WheeledRobotOptions options_;
  Pose pose_;
  Command motion_;
  std::int64_t ticks_ = 0;
  // Phases of the two waves of each wheel's slip.
  std::array<std::array<double, 2>, 2> phases_{};
};

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_WHEELED_ROBOT_H_
