// The trace that this thread works for, so that a line of the log can name it.
#ifndef SERVER_BASE_TRACE_SCOPE_H_
#define SERVER_BASE_TRACE_SCOPE_H_

#include "homing/base/trace_parent.h"

namespace homing::server {

// `trace` must outlive the scope; null: none. Scopes nest.
class TraceScope {
 public:
  explicit TraceScope(const TraceParent* trace) : before_(Slot()) { Slot() = trace; }
  ~TraceScope() { Slot() = before_; }
  TraceScope(const TraceScope&) = delete;
  TraceScope& operator=(const TraceScope&) = delete;

  // The calling thread's trace; null: none.
  static const TraceParent* Current() { return Slot(); }

 private:
  static const TraceParent*& Slot() {
    thread_local const TraceParent* current = nullptr;
    return current;
  }

  const TraceParent* const before_;
};

}  // namespace homing::server

#endif  // SERVER_BASE_TRACE_SCOPE_H_
