// The mass that the filter gives to steps of one journey.
#ifndef HOMING_PROFILE_STEP_MASS_H_
#define HOMING_PROFILE_STEP_MASS_H_

#include <cstdint>
#include <numeric>
#include <vector>

namespace homing {

// Mass of consecutive steps, over all directions and speeds.
struct StepMass {
  std::int64_t first = 0;
  std::vector<float> mass;

  double Sum() const { return std::accumulate(mass.begin(), mass.end(), 0.0); }
};

}  // namespace homing

#endif  // HOMING_PROFILE_STEP_MASS_H_
