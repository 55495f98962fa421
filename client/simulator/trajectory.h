// The robot's place at each frame.
#ifndef CLIENT_SIMULATOR_TRAJECTORY_H_
#define CLIENT_SIMULATOR_TRAJECTORY_H_

#include <cstdint>

#include "client/simulator/route.h"
#include "client/simulator/simulator.h"
#include "client/simulator/speed_profile.h"

namespace homing::client {

// Immutable.
class Trajectory {
 public:
  // The spec must be valid.
  Trajectory(const SimulationSpec& spec, std::uint64_t drive_seed);

  std::int64_t frame_count() const;
  double TimeS(std::int64_t frame) const;
  // Along the outbound route from home.
  double RouteMetres(std::int64_t frame) const;
  // On the route, with offset and wobble; heading as if outbound.
  Pose At(std::int64_t frame, const Route& route) const;
  // Unevenness of the ground under the robot at a frame.
  struct Jolt {
    // Radians, about the robot's long axis and about the axis to its left.
    double roll = 0;
    double pitch = 0;
    double height_m = 0;
  };
  Jolt JoltAt(std::int64_t frame) const;

 private:
  double DrivenMetres(double time_s) const;
  void Steer(double route_m, Pose& pose) const;

  SimulationSpec spec_;
  std::uint64_t drive_seed_;
  double length_m_;
  SpeedProfile speed_;
  double sway_phase_;
  double yaw_phase_;
  // Phases of the steering.
  double long_phase_;
  double short_phase_;
};

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_TRAJECTORY_H_
