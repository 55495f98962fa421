// The median of numbers. Source: own design.
#ifndef HOMING_FLOW_MEDIAN_H_
#define HOMING_FLOW_MEDIAN_H_

#include <algorithm>
#include <cstddef>
#include <vector>

namespace homing {

// The upper one of two middle values; 0 of none.
inline double Median(std::vector<double> values) {
  if (values.empty()) {
    return 0;
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace homing

#endif  // HOMING_FLOW_MEDIAN_H_
