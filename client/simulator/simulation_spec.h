// Limits of a simulation.
#ifndef CLIENT_SIMULATOR_SIMULATION_SPEC_H_
#define CLIENT_SIMULATOR_SIMULATION_SPEC_H_

#include "absl/status/status.h"
#include "client/simulator/simulator.h"

namespace homing::client {

// INVALID_ARGUMENT naming key, value and limit.
absl::Status Validate(const SimulationSpec& spec);

// spec.drive_seed, or one made from all other keys.
std::uint64_t DriveSeed(const SimulationSpec& spec);

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_SIMULATION_SPEC_H_
