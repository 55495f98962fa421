// The median of numbers.
#ifndef HOMING_FLOW_MEDIAN_H_
#define HOMING_FLOW_MEDIAN_H_

#include <cstdint>
#include <span>

namespace homing {

// The upper one of two middle values; 0 of none. No value is NaN. Costs the same whatever the
// order of the values: a selection that swaps them waits for its branches, ten times as long.
float Median(std::span<const float> values);
std::uint16_t Median(std::span<const std::uint16_t> values);

}  // namespace homing

#endif  // HOMING_FLOW_MEDIAN_H_
