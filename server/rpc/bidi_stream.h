// A two-way stream whose requests are handled in order, with a bounded read-ahead.
#ifndef SERVER_RPC_BIDI_STREAM_H_
#define SERVER_RPC_BIDI_STREAM_H_

#include <grpcpp/support/server_callback.h>

#include <chrono>
#include <cstddef>
#include <list>
#include <memory>
#include <optional>
#include <utility>

#include "homing/base/mutex.h"
#include "server/base/inline_policy.h"
#include "server/base/read_window.h"
#include "server/base/trace_scope.h"
#include "server/rpc/incoming_call.h"
#include "server/rpc/request_bytes.h"
#include "server/rpc/service_core.h"
#include "server/rpc/status_conversion.h"
#include "server/rpc/stream_registry.h"
#include "server/rpc/stream_watch.h"

namespace homing::server {

// OpenBidiStream creates the stream, which owns itself until gRPC calls OnDone. InlinePolicy
// decides which thread handles a request. Reading stops while the ReadWindow is full, so that
// HTTP/2 flow control slows the client down. gRPC calls the On... functions on its own threads,
// with at most one read and one write open.
template <typename Request, typename Response>
class BidiStream : public grpc::ServerBidiReactor<grpc::ByteBuffer, Response>,
                   public OpenStream,
                   public std::enable_shared_from_this<BidiStream<Request, Response>> {
 public:
  BidiStream(ServiceCore* core, grpc::CallbackServerContext* context, Rpc rpc)
      : core_(core),
        call_(core, *context, rpc),
        watch_(core, context),
        strand_(std::make_shared<Strand>(&core->pool, call_.turn_key())),
        share_(core->requests, call_.turn_key()) {}

  void Open() {
    self_ = this->shared_from_this();
    absl::Status admitted = call_.EnterStream();
    if (!core_->streams.Add(self_)) admitted = DrainingError();
    const MutexLock lock(mutex_);
    if (admitted.ok()) {
      ReadNext();
    } else {
      end_status_ = admitted;
      FinishIfOver();
    }
  }

  void Drain() override { PostEnd(DrainingError()); }

  void Tick() override {
    if (const absl::Status status = call_.CheckIdentity(); !status.ok()) End(status);
    if (!watch_.IsIdle()) return;
    bool writing = false;
    bool answered = false;
    {
      const MutexLock lock(mutex_);
      writing = writing_;
      answered = window_.IsEmpty();
    }
    if (writing) {
      // The client does not read its answers: an error would not arrive either.
      watch_.BreakOff();
    } else if (answered) {
      End(IdleError());
    }
  }

  void OnReadDone(bool ok) override {
    watch_.Moved();
    // No other read begins before reading_ is false.
    const std::size_t bytes = ok ? incoming_.Length() : 0;
    const auto request = std::make_shared<Request>();
    absl::Status parsed;
    if (ok) parsed = Guarded([&] { return ParseRequest(&incoming_, request.get()); });
    incoming_.Clear();
    if (ok && parsed.ok()) parsed = HoldRequest(bytes);
    WorkerPool::Task task;
    bool read_after_answer = false;
    {
      const MutexLock lock(mutex_);
      if (!ok || !parsed.ok()) {
        reading_ = false;
        half_closed_ = true;
        if (!parsed.ok()) {
          // The error takes its place in the queue: earlier requests are answered first.
          window_.Add(0);
          PostEnd(parsed);
        }
        FinishIfOver();
        return;
      }
      WorkerPool* const other_pool = OtherPoolOf(*request);
      task = [self = this->shared_from_this(), request] { self->HandleGuarded(*request); };
      read_after_answer = policy_.NoteWait(std::chrono::steady_clock::now() - read_begin_);
      if (other_pool != nullptr || !policy_.RunsInline(bytes)) {
        strand_->PostTo(other_pool != nullptr ? other_pool : &core_->pool, std::move(task));
        reading_ = false;
        ReadNext();
        return;
      }
    }
    // Run the task before the next read starts, or the next request could overtake this one.
    strand_->RunOrPost(std::move(task));
    const MutexLock lock(mutex_);
    reading_ = false;
    // If it does not read here, Answer or OnWriteDone starts the next read.
    if (!read_after_answer || window_.IsEmpty()) {
      ReadNext();
    }
  }

  void OnWriteDone(bool ok) override {
    watch_.Moved();
    const MutexLock lock(mutex_);
    writing_ = false;
    spare_.clear();
    spare_.splice(spare_.end(), writes_, writes_.begin());
    spare_.front().Clear();
    if (!ok) Break();
    WriteNext();
    ReadNext();
    FinishIfOver();
  }

  void OnCancel() override {
    const MutexLock lock(mutex_);
    Break();
    FinishIfOver();
  }

  void OnDone() override {
    watch_.Forget();
    const std::shared_ptr<BidiStream> self = std::move(self_);
    strand_->Post([self] { self->HandleDone(); });
    core_->streams.Remove(self);
  }

 protected:
  // The pool that handles a request which may wait for the store or has large images; null: the
  // workers'. Called for each request as it is read, in order, on gRPC's threads.
  virtual WorkerPool* OtherPoolOf(const Request& request) = 0;
  // Handles one request at a time, in order. Each one leads to one Answer, one NoAnswer or an End.
  virtual absl::Status Handle(const Request& request) = 0;
  // Ends the stream after the answers to earlier requests.
  virtual void EndInTurn(const absl::Status& status) { End(status); }
  virtual void HandleDone() {}  // Releases what belongs to the stream.

  // Sends the answer that `fill` writes into an empty message, whose memory is reused. Does nothing
  // once the stream has ended. Any thread may call it.
  template <typename Fill>
  void Answer(Fill fill) {
    const MutexLock lock(mutex_);
    if (end_status_ || finished_) return;
    if (spare_.empty()) spare_.emplace_back();
    writes_.splice(writes_.end(), spare_, spare_.begin());
    fill(&writes_.back());
    MarkAnswered();
    WriteNext();
    ReadNext();
  }
  void NoAnswer() {
    const MutexLock lock(mutex_);
    MarkAnswered();
    ReadNext();
    FinishIfOver();
  }
  // Ends the stream after the answers given so far.
  void End(const absl::Status& status) {
    const MutexLock lock(mutex_);
    if (!end_status_) end_status_ = status;
    FinishIfOver();
  }

  // Ends decoding once the client does not wait for an answer any more.
  DecodeLimits decode_limits() const {
    DecodeLimits limits = core_->options.decode;
    limits.cancellation = &watch_;
    return limits;
  }
  ServiceCore* core() { return core_; }
  IncomingCall& call() { return call_; }

 private:
  // Requests that all streams together may read ahead: fewer than the commit queue holds, so that
  // an overloaded server slows its clients down and refuses nothing.
  static constexpr std::size_t kReadAheadOfAll = 24576;

  // Counts a request that was read. RESOURCE_EXHAUSTED: those that wait take too much memory.
  absl::Status HoldRequest(std::size_t bytes) {
    const MutexLock lock(mutex_);
    window_.Add(bytes);
    if (share_.TrySet(window_.large_bytes())) return absl::OkStatus();
    return RequestMemoryError(core_->requests->most());
  }

  void MarkAnswered() HOMING_REQUIRES(mutex_) {
    window_.MarkAnswered();
    share_.TrySet(window_.large_bytes());
  }

  void PostEnd(const absl::Status& status) {
    strand_->Post([self = this->shared_from_this(), status] { self->EndInTurn(status); });
  }

  void HandleGuarded(const Request& request) {
    {
      const MutexLock lock(mutex_);
      if (end_status_ || finished_) {
        return;
      }
    }
    const TraceScope scope(call_.trace());
    const auto begin = std::chrono::steady_clock::now();
    const absl::Status status = Guarded([&] { return Handle(request); });
    policy_.NoteHandled(std::chrono::steady_clock::now() - begin);
    if (!status.ok()) {
      End(status);
    }
  }

  void ReadNext() HOMING_REQUIRES(mutex_) {
    const std::size_t most = core_->streams.ShareOf(kReadAheadOfAll, ReadWindow::kMaxRequests);
    if (reading_ || half_closed_ || end_status_ || finished_ ||
        window_.IsFull(writes_.size(), most)) {
      return;
    }
    reading_ = true;
    read_begin_ = std::chrono::steady_clock::now();
    this->StartRead(&incoming_);
  }

  void WriteNext() HOMING_REQUIRES(mutex_) {
    if (!writing_ && !writes_.empty() && !finished_) {
      writing_ = true;
      // Let gRPC send waiting answers in one packet: a commit makes many of them.
      grpc::WriteOptions options;
      if (writes_.size() > 1) {
        options.set_buffer_hint();
      }
      this->StartWrite(&writes_.front(), options);
    }
  }

  // The link is broken: nothing more can be written.
  void Break() HOMING_REQUIRES(mutex_) {
    if (!end_status_) {
      end_status_ = absl::CancelledError("the client disconnected");
    }
    if (!writes_.empty()) {
      writes_.resize(writing_ ? 1 : 0);
    }
  }

  void FinishIfOver() HOMING_REQUIRES(mutex_) {
    const bool answered = half_closed_ && window_.IsEmpty();
    if (finished_ || writing_ || !writes_.empty() || !(end_status_ || answered)) {
      return;
    }
    finished_ = true;
    this->Finish(call_.Finish(end_status_.value_or(absl::OkStatus())));
  }

  ServiceCore* const core_;
  IncomingCall call_;
  StreamWatch watch_;
  const std::shared_ptr<Strand> strand_;
  std::shared_ptr<BidiStream> self_;

  // Belongs to the read that runs.
  grpc::ByteBuffer incoming_;
  Mutex mutex_;
  // Lists and not deques: an empty deque takes 600 bytes, and there are many streams.
  std::list<Response> writes_ HOMING_GUARDED_BY(mutex_);
  // At most one answer, sent and cleared, whose memory is reused.
  std::list<Response> spare_ HOMING_GUARDED_BY(mutex_);
  ReadWindow window_ HOMING_GUARDED_BY(mutex_);
  // Of the requests in the window.
  RequestMemory::Share share_ HOMING_GUARDED_BY(mutex_);
  // Call NoteWait with mutex_ held.
  InlinePolicy policy_;
  std::optional<absl::Status> end_status_ HOMING_GUARDED_BY(mutex_);
  std::chrono::steady_clock::time_point read_begin_ HOMING_GUARDED_BY(mutex_);
  bool reading_ HOMING_GUARDED_BY(mutex_) = false;
  bool writing_ HOMING_GUARDED_BY(mutex_) = false;
  bool half_closed_ HOMING_GUARDED_BY(mutex_) = false;
  bool finished_ HOMING_GUARDED_BY(mutex_) = false;
};

}  // namespace homing::server

#endif  // SERVER_RPC_BIDI_STREAM_H_
