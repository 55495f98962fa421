// Ends a long computation early when nobody waits for its result.
#ifndef HOMING_BASE_CANCELLATION_H_
#define HOMING_BASE_CANCELLATION_H_

#include "absl/status/status.h"

namespace homing {

// Asked between the stages of a computation.
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

// CANCELLED if nobody waits any more. Null: somebody always waits.
inline absl::Status CheckAwaited(const Cancellation* cancellation) {
  return cancellation != nullptr && cancellation->IsCancelled()
             ? absl::CancelledError("the caller does not wait for the result any more")
             : absl::OkStatus();
}

}  // namespace homing

#endif  // HOMING_BASE_CANCELLATION_H_
