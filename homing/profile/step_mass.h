// The mass that the filter gives to steps of one journey.
#ifndef HOMING_PROFILE_STEP_MASS_H_
#define HOMING_PROFILE_STEP_MASS_H_

#include <cstdint>
#include <span>
#include <vector>

namespace homing {

// Adds in several partial sums, as fast as the values can be read.
double SumOf(std::span<const float> values);

// Mass of consecutive steps, over all directions and speeds.
struct StepMass {
  std::int64_t first = 0;
  std::vector<float> mass;

  double Sum() const { return SumOf(mass); }
};

}  // namespace homing

#endif  // HOMING_PROFILE_STEP_MASS_H_
