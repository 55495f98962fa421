// Watches when a stream was last active, and can cancel it.
#ifndef SERVER_RPC_STREAM_WATCH_H_
#define SERVER_RPC_STREAM_WATCH_H_

#include <grpcpp/server_context.h>

#include <atomic>

#include "homing/base/cancellation.h"
#include "homing/base/mutex.h"
#include "server/rpc/service_core.h"

namespace homing::server {

// Thread-safe.
class StreamWatch : public Cancellation {
 public:
  StreamWatch(ServiceCore* core, grpc::ServerContextBase* context)
      : core_(core), context_(context), moved_(core->options.clock()) {}

  void Moved() { moved_ = core_->options.clock(); }
  // The stream was not active for idle_stream_s.
  bool IsIdle() const {
    const std::chrono::seconds most(core_->options.limits.idle_stream_s);
    return most.count() > 0 && core_->options.clock() - moved_.load() > most;
  }
  // The client cancelled the call, its link broke, or BreakOff ended it.
  bool IsCancelled() const override {
    const MutexLock lock(mutex_);
    return context_ == nullptr || context_->IsCancelled();
  }
  // Cancels the call: the client sees CANCELLED, and the stream ends as after a broken link.
  void BreakOff() {
    const MutexLock lock(mutex_);
    if (context_ != nullptr) {
      context_->TryCancel();
    }
  }
  // Called from OnDone: the context is no longer valid.
  void Forget() {
    const MutexLock lock(mutex_);
    context_ = nullptr;
  }

 private:
  ServiceCore* const core_;
  // Recursive: gRPC may call back, up to OnDone, before TryCancel returns.
  mutable RecursiveMutex mutex_;
  grpc::ServerContextBase* context_ HOMING_GUARDED_BY(mutex_);
  std::atomic<TimePoint> moved_;
};

}  // namespace homing::server

#endif  // SERVER_RPC_STREAM_WATCH_H_
