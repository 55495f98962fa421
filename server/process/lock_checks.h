// What Debian's abseil checks at each lock.
#ifndef SERVER_PROCESS_LOCK_CHECKS_H_
#define SERVER_PROCESS_LOCK_CHECKS_H_

#include "absl/synchronization/mutex.h"

namespace homing {

// Debian builds abseil with assertions: each lock that gRPC takes then looks for cycles in a graph
// of all locks, under one lock of the process. For main().
inline void SkipLockChecks() {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
}

}  // namespace homing

#endif  // SERVER_PROCESS_LOCK_CHECKS_H_
