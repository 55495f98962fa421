// A word for programs, carried by a status beside its message.
#ifndef SERVER_BASE_ERROR_REASON_H_
#define SERVER_BASE_ERROR_REASON_H_

#include <map>
#include <string>

#include "absl/status/status.h"

namespace homing::server {

// Metadata: when a retry may succeed, ms. Without it: in a second.
inline constexpr char kRetryAfterMs[] = "retry_after_ms";

struct ErrorReason {
  // UPPER_SNAKE_CASE.
  std::string reason;
  // What a program needs to act on it, for example {"due", "7"}.
  std::map<std::string, std::string> metadata;
};

// The same error, with a reason. REQUIRES: !status.ok().
absl::Status WithReason(absl::Status status, const ErrorReason& reason);

// The reason given, or else one that follows from the code.
ErrorReason ReasonOf(const absl::Status& status);

}  // namespace homing::server

#endif  // SERVER_BASE_ERROR_REASON_H_
