// Where the robot is at each frame. Source: own design.
#ifndef CLIENT_SIMULATOR_TRAJECTORY_H_
#define CLIENT_SIMULATOR_TRAJECTORY_H_

#include <cstdint>

#include "client/simulator/route.h"
#include "client/simulator/simulator.h"

namespace homing::client {

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

 private:
  double DrivenMetres(double time_s) const;

  SimulationSpec spec_;
  double speed_m_s_;
  double sway_phase_;
  double yaw_phase_;
};

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_TRAJECTORY_H_
