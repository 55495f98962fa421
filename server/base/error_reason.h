// A machine-readable reason in a status, beside its message.
#ifndef SERVER_BASE_ERROR_REASON_H_
#define SERVER_BASE_ERROR_REASON_H_

#include <map>
#include <string>

#include "absl/status/status.h"

namespace homing::server {

// Metadata key: after how many ms a retry may succeed. Default: 1000.
inline constexpr char kRetryAfterMs[] = "retry_after_ms";

struct ErrorReason {
  // UPPER_SNAKE_CASE.
  std::string reason;
  // Values that a client needs to react, for example {"due", "7"}.
  std::map<std::string, std::string> metadata;
};

// The same error, with a reason. REQUIRES: !status.ok().
absl::Status WithReason(absl::Status status, const ErrorReason& reason);

// The reason set by WithReason, or the name of the status code.
ErrorReason ReasonOf(const absl::Status& status);

}  // namespace homing::server

#endif  // SERVER_BASE_ERROR_REASON_H_
