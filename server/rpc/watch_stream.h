// A stream of states from the server: of several changes only the last is sent, so that a slow
// client costs no memory.
#ifndef SERVER_RPC_WATCH_STREAM_H_
#define SERVER_RPC_WATCH_STREAM_H_

#include <grpcpp/support/server_callback.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "homing/base/mutex.h"
#include "server/base/trace_scope.h"
#include "server/fleet/fleet_board.h"
#include "server/rpc/incoming_call.h"
#include "server/rpc/service_core.h"
#include "server/rpc/status_conversion.h"
#include "server/rpc/stream_watch.h"

namespace homing::server {

// The stream owns itself until gRPC calls OnDone. It counts among all open streams, but not among
// those of the robot that it watches.
template <typename Response>
class WatchStream : public grpc::ServerWriteReactor<Response>,
                    public OpenStream,
                    public FleetWatcher,
                    public std::enable_shared_from_this<WatchStream<Response>> {
 public:
  // `resource` is the robot watched; empty: all.
  WatchStream(ServiceCore* core, grpc::CallbackServerContext* context, Rpc rpc,
              std::string resource)
      : core_(core),
        call_(core, *context, rpc),
        watch_(core, context),
        resource_(std::move(resource)) {}

  void Open() {
    self_ = this->shared_from_this();
    absl::Status entered = call_.EnterWatch();
    if (!core_->streams.Add(self_)) {
      entered = DrainingError();
    } else if (entered.ok() && !core_->store_reads.TryRun([self = self_] { self->Begin(); })) {
      entered = BusyError();
    }
    if (!entered.ok()) End(entered);
  }

  void Drain() override { End(DrainingError()); }
  void Tick() override {
    if (const absl::Status status = call_.CheckIdentity(); !status.ok()) End(status);
  }

  void Wake() override {
    const MutexLock lock(mutex_);
    WriteNext();
  }

  void OnWriteDone(bool ok) override {
    const MutexLock lock(mutex_);
    writing_ = false;
    if (!ok && !end_) end_ = absl::OkStatus();
    WriteNext();
  }

  // A watcher leaves when it has seen enough: that is no error.
  void OnCancel() override { End(absl::OkStatus()); }

  void OnDone() override {
    watch_.Forget();
    const std::shared_ptr<WatchStream> self = std::move(self_);
    core_->streams.Remove(self);
  }

 protected:
  // Checks the request, in a worker that reads the store.
  virtual absl::Status Prepare(ServiceCore* core) = 0;
  // Fills in the next message; false: there is nothing new. Under the stream's lock.
  virtual bool Next(ServiceCore* core, const IncomingCall& call, Response* response) = 0;

 private:
  void Begin() {
    const TraceScope scope(call_.trace());
    {
      // Nobody waits for what Prepare reads.
      const MutexLock lock(mutex_);
      if (end_) return;
    }
    const absl::Status status = Guarded([this]() -> absl::Status {
      const absl::Status allowed = call_.Authorize(resource_);
      return allowed.ok() ? Prepare(core_) : allowed;
    });
    if (!status.ok()) {
      End(status);
      return;
    }
    core_->fleet.Watch(resource_, self_);
    const MutexLock lock(mutex_);
    begun_ = true;
    WriteNext();
  }

  void End(const absl::Status& status) {
    const MutexLock lock(mutex_);
    if (!end_) end_ = status;
    WriteNext();
  }

  void WriteNext() HOMING_REQUIRES(mutex_) {
    if (writing_ || finished_) return;
    if (end_) {
      finished_ = true;
      this->Finish(call_.Finish(*end_));
      return;
    }
    response_.Clear();
    if (begun_ && Next(core_, call_, &response_)) {
      writing_ = true;
      this->StartWrite(&response_);
    }
  }

  ServiceCore* const core_;
  IncomingCall call_;
  StreamWatch watch_;
  const std::string resource_;
  std::shared_ptr<WatchStream> self_;
  Mutex mutex_;
  Response response_ HOMING_GUARDED_BY(mutex_);
  std::optional<absl::Status> end_ HOMING_GUARDED_BY(mutex_);
  bool begun_ HOMING_GUARDED_BY(mutex_) = false;
  bool writing_ HOMING_GUARDED_BY(mutex_) = false;
  bool finished_ HOMING_GUARDED_BY(mutex_) = false;
};

}  // namespace homing::server

#endif  // SERVER_RPC_WATCH_STREAM_H_
