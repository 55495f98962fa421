// The median of numbers.
#ifndef HOMING_FLOW_MEDIAN_H_
#define HOMING_FLOW_MEDIAN_H_

#include <cstdint>
#include <span>

namespace homing {

// The upper one of two middle values; 0 if there are none. REQUIRES: no value is NaN. Branch-free:
// the run time does not depend on the order of the values. A selection that swaps values takes ten
// times as long, because its branches are mispredicted.
float Median(std::span<const float> values);
std::uint16_t Median(std::span<const std::uint16_t> values);

}  // namespace homing

#endif  // HOMING_FLOW_MEDIAN_H_
