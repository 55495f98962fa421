// Frames of the simulated robot.
#ifndef CLIENT_SOURCE_SIMULATED_SOURCE_H_
#define CLIENT_SOURCE_SIMULATED_SOURCE_H_

#include <memory>

#include "absl/status/statusor.h"
#include "client/simulator/simulator.h"
#include "client/source/frame_source.h"

namespace homing::client {

// GRAY8 frames of one camera. INVALID_ARGUMENT.
absl::StatusOr<std::unique_ptr<FrameSource>> MakeSimulatedSource(const SimulationSpec& spec,
                                                                 Side camera);

}  // namespace homing::client

#endif  // CLIENT_SOURCE_SIMULATED_SOURCE_H_
