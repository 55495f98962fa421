// Ends a long computation early when nobody waits for its result.
#ifndef HOMING_BASE_CANCELLATION_H_
#define HOMING_BASE_CANCELLATION_H_

#include "absl/status/status.h"

namespace homing {

// A computation calls IsCancelled between its stages, on its own thread.
class Cancellation {
 public:
  virtual ~Cancellation() = default;
  // Must be cheap.
  virtual bool IsCancelled() const = 0;

 protected:
  Cancellation() = default;
  Cancellation(const Cancellation&) = default;
  Cancellation& operator=(const Cancellation&) = default;
};

// CANCELLED if nobody waits for the result any more. Null: never cancelled.
inline absl::Status CheckAwaited(const Cancellation* cancellation) {
  return cancellation != nullptr && cancellation->IsCancelled()
             ? absl::CancelledError("the caller does not wait for the result any more")
             : absl::OkStatus();
}

}  // namespace homing

#endif  // HOMING_BASE_CANCELLATION_H_
