// An error for a request that exceeds a limit: a retry cannot succeed.
#ifndef HOMING_BASE_LIMIT_ERROR_H_
#define HOMING_BASE_LIMIT_ERROR_H_

#include <string>

#include "absl/status/status.h"
#include "absl/strings/cord.h"
#include "homing/base/field_error.h"

namespace homing {

// The payload that holds a machine-readable reason.
inline constexpr char kReasonPayload[] = "homing/reason";

// MustBe(field, value, rule) whose reason is `limit`, for example "PIXELS".
template <typename T>
absl::Status LimitError(const std::string& limit, const std::string& field, const T& value,
                        const std::string& rule) {
  absl::Status status = MustBe(field, value, rule);
  status.SetPayload(kReasonPayload, absl::Cord(limit));
  return status;
}

}  // namespace homing

#endif  // HOMING_BASE_LIMIT_ERROR_H_
