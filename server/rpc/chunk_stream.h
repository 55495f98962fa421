// A streaming method that answers with a file in chunks.
#ifndef SERVER_RPC_CHUNK_STREAM_H_
#define SERVER_RPC_CHUNK_STREAM_H_

#include <grpcpp/support/server_callback.h>

#include <memory>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/base/cancellation.h"
#include "homing/base/status_macros.h"
#include "server/base/trace_scope.h"
#include "server/rpc/incoming_call.h"
#include "server/rpc/request_bytes.h"
#include "server/rpc/service_core.h"
#include "server/rpc/status_conversion.h"
#include "server/rpc/stream_watch.h"

namespace homing::server {

inline constexpr std::size_t kChunkBytes = 256 << 10;

// Ends a stream whose caller lost its access, or that is idle.
inline void CutOffIfStale(const IncomingCall& call, StreamWatch* watch) {
  if (watch->IsIdle() || !call.CheckIdentity().ok()) {
    watch->BreakOff();
  }
}

// `Response` has a field `chunk`. The stream owns itself until gRPC calls OnDone.
template <typename Request, typename Response>
class ChunkStream : public grpc::ServerBidiReactor<grpc::ByteBuffer, Response>,
                    public OpenStream,
                    public std::enable_shared_from_this<ChunkStream<Request, Response>> {
 public:
  // `pool` belongs to the core and makes the file.
  ChunkStream(ServiceCore* core, grpc::CallbackServerContext* context, Rpc rpc, WorkerPool* pool)
      : core_(core), pool_(pool), call_(core, *context, rpc), watch_(core, context) {}

  void Open() {
    self_ = this->shared_from_this();
    absl::Status entered = call_.EnterStream();
    if (!core_->streams.Add(self_)) {
      entered = DrainingError();
    }
    if (entered.ok()) {
      this->StartRead(&bytes_);
    } else {
      this->Finish(call_.Finish(entered));
    }
  }

  // A started file is completed; the server's deadline for draining ends it otherwise.
  void Drain() override {}
  void Tick() override { CutOffIfStale(call_, &watch_); }

  void OnReadDone(bool ok) override {
    watch_.Moved();
    absl::Status status = ParseOnlyRequest(ok, watch_, &bytes_, &request_);
    bytes_.Clear();
    const auto self = this->shared_from_this();
    if (status.ok() && !pool_->TryRun([self] { self->Begin(); }, call_.turn_key())) {
      status = BusyError();
    }
    if (!status.ok()) this->Finish(call_.Finish(status));
  }

  void OnWriteDone(bool ok) override {
    watch_.Moved();
    if (ok) {
      WriteNext();
    } else {
      this->Finish(call_.Finish(absl::CancelledError("the client disconnected")));
    }
  }

  void OnDone() override {
    watch_.Forget();
    Release(core_);
    const std::shared_ptr<ChunkStream> self = std::move(self_);
    core_->streams.Remove(self);
  }

 protected:
  // Makes the file.
  virtual absl::Status Prepare(const Request& request, ServiceCore* core, IncomingCall* call) = 0;
  // The next chunk, at most kChunkBytes; empty: the end.
  virtual absl::StatusOr<std::string> NextChunk() = 0;
  // Frees what Prepare took from the core; called once, at the end.
  virtual void Release(ServiceCore* /*core*/) {}

 private:
  void Begin() {
    const TraceScope scope(call_.trace());
    const absl::Status status = Guarded([this] {
      HOMING_RETURN_IF_ERROR(CheckAwaited(&watch_));
      return Prepare(request_, core_, &call_);
    });
    if (status.ok()) {
      WriteNext();
    } else {
      this->Finish(call_.Finish(status));
    }
  }

  void WriteNext() {
    absl::StatusOr<std::string> chunk = NextChunk();
    if (!chunk.ok() || chunk->empty()) {
      this->Finish(call_.Finish(chunk.status()));
      return;
    }
    response_.set_chunk(*std::move(chunk));
    this->StartWrite(&response_);
  }

  ServiceCore* const core_;
  WorkerPool* const pool_;
  IncomingCall call_;
  StreamWatch watch_;
  std::shared_ptr<ChunkStream> self_;
  grpc::ByteBuffer bytes_;
  Request request_;
  Response response_;
};

}  // namespace homing::server

#endif  // SERVER_RPC_CHUNK_STREAM_H_
