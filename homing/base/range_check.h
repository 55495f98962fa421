// One bound of one option, as an error that names field, value and limit. Source: own design.
#ifndef HOMING_BASE_RANGE_CHECK_H_
#define HOMING_BASE_RANGE_CHECK_H_

#include <string>

#include "absl/status/status.h"
#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"

namespace homing {

// INVALID_ARGUMENT unless low <= value <= high (NaN is outside).
template <typename T>
absl::Status CheckRange(const std::string& field, T value, T low, T high) {
  if (value >= low && value <= high) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat(field, " is ", value, ", must be in [", low, ", ", high, "]"));
}

// INVALID_ARGUMENT unless low < value <= high (NaN is outside).
template <typename T>
absl::Status CheckAbove(const std::string& field, T value, T low, T high) {
  if (value > low && value <= high) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat(field, " is ", value, ", must be in (", low, ", ", high, "]"));
}

// The same error with the name of what holds the field before it: "flow: cell_px is ...".
inline absl::Status Within(const std::string& holder, const absl::Status& status) {
  if (status.ok()) {
    return status;
  }
  absl::Status longer(status.code(), absl::StrCat(holder, ": ", std::string(status.message())));
  status.ForEachPayload(
      [&](absl::string_view url, const absl::Cord& value) { longer.SetPayload(url, value); });
  return longer;
}

}  // namespace homing

#endif  // HOMING_BASE_RANGE_CHECK_H_
