// A stream of states from the server: of several changes only the last is sent, so that a slow
// client costs no memory.
#ifndef SERVER_RPC_WATCH_STREAM_H_
#define SERVER_RPC_WATCH_STREAM_H_

#include <grpcpp/support/server_callback.h>

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"
#include "server/base/trace_scope.h"
#include "server/fleet/fleet_board.h"
#include "server/rpc/incoming_call.h"
#include "server/rpc/request_bytes.h"
#include "server/rpc/service_core.h"
#include "server/rpc/status_conversion.h"
#include "server/rpc/stream_watch.h"

namespace homing::server {

// The stream owns itself until gRPC calls OnDone. It counts among all open streams, but not among
// those of the robot that it watches.
template <typename Request, typename Response>
class WatchStream : public grpc::ServerBidiReactor<grpc::ByteBuffer, Response>,
                    public OpenStream,
                    public FleetWatcher,
                    public std::enable_shared_from_this<WatchStream<Request, Response>> {
 public:
  WatchStream(ServiceCore* core, grpc::CallbackServerContext* context, Rpc rpc)
      : core_(core),
        call_(core, *context, rpc),
        watch_(core, context),
        opened_(core->options.clock()) {}

  void Open() {
    self_ = this->shared_from_this();
    absl::Status entered = call_.EnterWatch();
    if (!core_->streams.Add(self_)) entered = DrainingError();
    if (entered.ok()) {
      this->StartRead(&bytes_);
    } else {
      End(entered);
    }
  }

  void Drain() override { End(DrainingError()); }
  void Tick() override {
    absl::Status status = call_.CheckIdentity();
    if (IsDeaf()) {
      watch_.BreakOff();
      return;
    }
    if (unread_ && core_->options.clock() - opened_ > kRequestTime) status = RequestTimeError();
    if (!status.ok()) End(status);
  }

  void OnReadDone(bool ok) override {
    absl::Status status = ParseOnlyRequest(ok, watch_, &bytes_, &request_);
    bytes_.Clear();
    unread_ = false;
    const auto self = this->shared_from_this();
    if (status.ok() && !core_->store_reads.TryRun([self] { self->Begin(); }, call_.turn_key())) {
      status = BusyError();
    }
    if (!status.ok()) End(status);
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
  // The robot watched; empty: all.
  virtual std::string ResourceOf(const Request& request) = 0;
  // Checks the resource, in a worker that reads the store.
  virtual absl::Status Prepare(ServiceCore* core, const std::string& resource) = 0;
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
    const std::string resource = ResourceOf(request_);
    const absl::Status status = Guarded([&]() -> absl::Status {
      HOMING_RETURN_IF_ERROR(call_.Authorize(resource));
      return Prepare(core_, resource);
    });
    if (!status.ok()) {
      End(status);
      return;
    }
    core_->fleet.Watch(resource, this->shared_from_this());
    const MutexLock lock(mutex_);
    begun_ = true;
    WriteNext();
  }

  // The client does not read what was written: an error would not arrive either.
  bool IsDeaf() {
    const MutexLock lock(mutex_);
    return writing_ && watch_.IsIdle();
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
      watch_.Moved();
      this->StartWrite(&response_);
    }
  }

  ServiceCore* const core_;
  IncomingCall call_;
  StreamWatch watch_;
  const TimePoint opened_;
  std::shared_ptr<WatchStream> self_;
  grpc::ByteBuffer bytes_;
  Request request_;
  std::atomic<bool> unread_ = true;
  Mutex mutex_;
  Response response_ HOMING_GUARDED_BY(mutex_);
  std::optional<absl::Status> end_ HOMING_GUARDED_BY(mutex_);
  bool begun_ HOMING_GUARDED_BY(mutex_) = false;
  bool writing_ HOMING_GUARDED_BY(mutex_) = false;
  bool finished_ HOMING_GUARDED_BY(mutex_) = false;
};

}  // namespace homing::server

#endif  // SERVER_RPC_WATCH_STREAM_H_
