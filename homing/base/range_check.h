// Checks that a value is within its bounds.
#ifndef HOMING_BASE_RANGE_CHECK_H_
#define HOMING_BASE_RANGE_CHECK_H_

#include <string>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"

namespace homing {

// INVALID_ARGUMENT unless low <= value <= high (NaN is outside).
template <typename T>
absl::Status CheckRange(const std::string& field, T value, T low, T high,
                        const std::string& unit = "") {
  if (value >= low && value <= high) {
    return absl::OkStatus();
  }
  return MustBe(field, value,
                absl::StrCat("in [", low, ", ", high, "]", unit.empty() ? "" : " ", unit));
}

// INVALID_ARGUMENT unless low < value <= high (NaN is outside).
template <typename T>
absl::Status CheckAbove(const std::string& field, T value, T low, T high,
                        const std::string& unit = "") {
  if (value > low && value <= high) {
    return absl::OkStatus();
  }
  return MustBe(field, value,
                absl::StrCat("in (", low, ", ", high, "]", unit.empty() ? "" : " ", unit));
}

}  // namespace homing

#endif  // HOMING_BASE_RANGE_CHECK_H_
