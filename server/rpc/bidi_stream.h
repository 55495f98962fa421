// A two-way stream whose messages are handled in order, with a bounded read-ahead.
// Source: own design.
#ifndef SERVER_RPC_BIDI_STREAM_H_
#define SERVER_RPC_BIDI_STREAM_H_

#include <grpcpp/support/server_callback.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "server/rpc/incoming_call.h"
#include "server/rpc/read_mark.h"
#include "server/rpc/service_core.h"
#include "server/rpc/status_conversion.h"
#include "server/rpc/stream_registry.h"
#include "server/rpc/stream_watch.h"

namespace homing::server {

// Made by OpenBidiStream; holds itself until gRPC has done with it. gRPC's threads handle what is
// quick and queue the rest; reading stops while kReadAhead messages (fewer where there are many
// streams) or kReadAheadBytes bytes are not yet answered, so that HTTP/2 flow control holds the
// client back.
template <typename Request, typename Response>
class BidiStream : public grpc::ServerBidiReactor<Request, Response>,
                   public OpenStream,
                   public std::enable_shared_from_this<BidiStream<Request, Response>> {
 public:
  BidiStream(ServiceCore* core, grpc::CallbackServerContext* context, Rpc rpc)
      : core_(core),
        call_(core, *context, rpc),
        watch_(core, context),
        strand_(std::make_shared<Strand>(&core->pool)) {}

  void Open() {
    self_ = this->shared_from_this();
    absl::Status admitted = call_.EnterStream();
    if (!core_->streams.Add(self_)) admitted = DrainingError();
    const std::lock_guard lock(mutex_);
    if (admitted.ok()) {
      ReadNext();
    } else {
      end_status_ = admitted;
      FinishIfOver();
    }
  }

  void Drain() override { PostEnd(DrainingError()); }

  void Tick() override {
    if (const absl::Status status = call_.CheckIdentity(); !status.ok()) {
      End(status);
    }
    if (!watch_.IsIdle()) {
      return;
    }
    std::unique_lock lock(mutex_);
    if (writing_) {
      // It does not take its answers: nothing that is said would arrive.
      lock.unlock();
      watch_.BreakOff();
    } else if (unanswered_.empty()) {
      lock.unlock();
      End(IdleError());
    }
  }

  void OnReadDone(bool ok) override {
    watch_.Moved();
    WorkerPool::Task task;
    bool unhurried = false;
    {
      const std::lock_guard lock(mutex_);
      if (!ok) {
        reading_ = false;
        half_closed_ = true;
        if (IsUndecodable(*incoming_)) {
          // Keeps its place behind the requests before, which are answered first.
          unanswered_.push_back(0);
          PostEnd(UndecodableError(*incoming_));
        }
        FinishIfOver();
        return;
      }
      const std::size_t bytes = incoming_->ByteSizeLong();
      unanswered_.push_back(bytes);
      unanswered_bytes_ += bytes;
      task = [self = this->shared_from_this(), request = std::move(incoming_)] {
        self->HandleGuarded(*request);
      };
      const bool awaited = std::chrono::steady_clock::now() - read_begin_ > kUnhurried;
      // Not the first of a burst: after that, more is there.
      unhurried = std::exchange(awaited_, awaited) && awaited;
      if (!quick_ || bytes > kHereBytes) {
        strand_->Post(std::move(task));
        reading_ = false;
        ReadNext();
        return;
      }
    }
    // Nothing is read meanwhile: what came next could overtake it.
    strand_->RunOrPost(std::move(task));
    const std::lock_guard lock(mutex_);
    reading_ = false;
    // The next is not there yet. Asked for after the answer, it lets gRPC put the window update
    // into the answer's packet; asked for before, there is a packet of its own.
    if (!unhurried || unanswered_.empty()) {
      ReadNext();
    }
  }

  void OnWriteDone(bool ok) override {
    watch_.Moved();
    const std::lock_guard lock(mutex_);
    writing_ = false;
    spare_.clear();
    spare_.splice(spare_.end(), writes_, writes_.begin());
    spare_.front().Clear();
    if (!ok) {
      Break();
    }
    WriteNext();
    ReadNext();
    FinishIfOver();
  }

  void OnCancel() override {
    const std::lock_guard lock(mutex_);
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
  // One at a time, in order. Each request comes to one Answer, one NoAnswer or an End.
  virtual absl::Status Handle(const Request& request) = 0;
  // Ends the stream after the answers to the requests before.
  virtual void EndInTurn(const absl::Status& status) { End(status); }
  virtual void HandleDone() {}  // Frees what belongs to the stream.

  // Any thread. `fill` is given an empty answer: one that was sent, whose memory is used again. It
  // is not called if no answer can be given any more.
  template <typename Fill>
  void Answer(Fill fill) {
    const std::lock_guard lock(mutex_);
    if (end_status_ || finished_) return;
    if (spare_.empty()) spare_.emplace_back();
    writes_.splice(writes_.end(), spare_, spare_.begin());
    fill(&writes_.back());
    Settle();
    WriteNext();
    ReadNext();
  }
  void NoAnswer() {
    const std::lock_guard lock(mutex_);
    Settle();
    ReadNext();
    FinishIfOver();
  }
  // After the answers given so far.
  void End(const absl::Status& status) {
    const std::lock_guard lock(mutex_);
    if (!end_status_) {
      end_status_ = status;
    }
    FinishIfOver();
  }

  ServiceCore* core() { return core_; }
  IncomingCall& call() { return call_; }

 private:
  // Enough that a commit's time is shared by many observations; of frames, bytes come first.
  static constexpr std::size_t kReadAhead = 256;
  static constexpr std::size_t kReadAheadBytes = 1 << 20;
  // Of all streams together: fewer than may wait for their commit, so that a server with too much
  // to do slows its clients down and refuses nothing.
  static constexpr std::size_t kReadAheadOfAll = 24576;
  // What is handled on the thread that read it: small messages of a stream whose last took no
  // longer. To wake another thread costs as much as to handle many a message.
  static constexpr std::size_t kHereBytes = 65536;
  static constexpr std::chrono::microseconds kQuick{1000};
  // A stream whose messages, two in a row, were awaited for longer: longer than most answers take.
  static constexpr std::chrono::milliseconds kUnhurried{5};

  void PostEnd(const absl::Status& status) {
    strand_->Post([self = this->shared_from_this(), status] { self->EndInTurn(status); });
  }

  void HandleGuarded(const Request& request) {
    {
      const std::lock_guard lock(mutex_);
      if (end_status_ || finished_) {
        return;
      }
    }
    const auto begin = std::chrono::steady_clock::now();
    const absl::Status status = Guarded([&] { return Handle(request); });
    quick_ = std::chrono::steady_clock::now() - begin < kQuick;
    if (!status.ok()) {
      End(status);
    }
  }

  // The functions below: REQUIRES mutex_.
  void ReadNext() {
    const std::size_t most = core_->streams.ShareOf(kReadAheadOfAll, kReadAhead);
    const bool full =
        unanswered_.size() + writes_.size() >= most || unanswered_bytes_ >= kReadAheadBytes;
    if (reading_ || half_closed_ || end_status_ || finished_ || full) {
      return;
    }
    reading_ = true;
    read_begin_ = std::chrono::steady_clock::now();
    incoming_ = std::make_shared<Request>();
    MarkUnread(incoming_.get());
    this->StartRead(incoming_.get());
  }

  void WriteNext() {
    if (!writing_ && !writes_.empty() && !finished_) {
      writing_ = true;
      // Answers that wait leave together: a commit makes many.
      grpc::WriteOptions options;
      if (writes_.size() > 1) {
        options.set_buffer_hint();
      }
      this->StartWrite(&writes_.front(), options);
    }
  }

  // The oldest request is answered.
  void Settle() {
    if (!unanswered_.empty()) {
      unanswered_bytes_ -= unanswered_.front();
      unanswered_.erase(unanswered_.begin());
    }
  }

  // The link is gone: nothing more can be written.
  void Break() {
    if (!end_status_) {
      end_status_ = absl::CancelledError("the client went away");
    }
    if (!writes_.empty()) {
      writes_.resize(writing_ ? 1 : 0);
    }
  }

  void FinishIfOver() {
    const bool answered = half_closed_ && unanswered_.empty();
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

  std::mutex mutex_;
  std::shared_ptr<Request> incoming_;
  // Lists, and a vector of few: an empty deque takes 600 bytes, and streams are many.
  std::list<Response> writes_;
  // At most one, empty: it was sent, and its memory is used again.
  std::list<Response> spare_;
  // Sizes of the requests read and not yet answered, bytes.
  std::vector<std::size_t> unanswered_;
  std::size_t unanswered_bytes_ = 0;
  std::optional<absl::Status> end_status_;
  std::chrono::steady_clock::time_point read_begin_;
  // The last message: for longer than kUnhurried.
  bool awaited_ = false;
  std::atomic<bool> quick_ = false;
  bool reading_ = false;
  bool writing_ = false;
  bool half_closed_ = false;
  bool finished_ = false;
};

}  // namespace homing::server

#endif  // SERVER_RPC_BIDI_STREAM_H_
