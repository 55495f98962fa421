// Turns off the lock checks of Debian's abseil.
#ifndef SERVER_PROCESS_LOCK_CHECKS_H_
#define SERVER_PROCESS_LOCK_CHECKS_H_

#include "absl/synchronization/mutex.h"

namespace homing {

// Debian builds abseil with assertions: each lock that gRPC takes then searches a graph of all
// locks for cycles, under one lock of the process. Call it in main().
inline void SkipLockChecks() {
  absl::SetMutexDeadlockDetectionMode(absl::OnDeadlockCycle::kIgnore);
}

}  // namespace homing

#endif  // SERVER_PROCESS_LOCK_CHECKS_H_
