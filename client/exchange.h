// Makes one attempt of a bidirectional stream: sends observations within a window, and receives
// answers.
#ifndef CLIENT_EXCHANGE_H_
#define CLIENT_EXCHANGE_H_

#include <grpcpp/client_context.h>
#include <grpcpp/support/sync_stream.h>

#include <functional>
#include <memory>
#include <thread>

#include "absl/status/status.h"
#include "client/answer_check.h"
#include "client/answer_limit.h"
#include "client/resend_buffer.h"
#include "client/rpc_status.h"
#include "homing/base/mutex.h"

namespace homing::client {

// `fill` makes a request from an observation, on the calling thread. `on_answer` is called on
// another thread, in order. An error of either ends the stream and is returned.
template <typename Request, typename Response>
class Exchange {
 public:
  using Stream = grpc::ClientReaderWriterInterface<Request, Response>;
  using Fill = std::function<void(const v1::Observation&, Request*)>;
  using OnAnswer = std::function<absl::Status(const Response&)>;

  Exchange(grpc::ClientContext* context, Stream* stream, AnswerLimit* limit, int window)
      : context_(context), stream_(stream), limit_(limit), window_(window) {}

  // Sends to the end of `buffer`. UNAVAILABLE: the stream ended before that. Whether all were
  // answered is for the caller to check.
  absl::Status Run(ResendBuffer* buffer, const Fill& fill, const OnAnswer& on_answer) {
    std::thread reader([&] { ReadAnswers(on_answer); });
    WriteAll(buffer, fill);
    reader.join();
    absl::Status status = FromGrpc(stream_->Finish());
    const MutexLock lock(mutex_);
    // The link's error comes first: a failed source returns its error again once the link is
    // restored.
    if (source_failed_ && !status.ok()) return status;
    if (!error_.ok()) return error_;
    if (!status.ok()) return status;
    return ended_ ? absl::OkStatus() : EndedEarly();
  }

 private:
  void ReadAnswers(const OnAnswer& on_answer) {
    Response response;
    while (stream_->Read(&response)) {
      limit_->Answered();
      if (const absl::Status status = on_answer(response); !status.ok()) Fail(status);
      limit_->Continue();
      const MutexLock lock(mutex_);
      --open_;
      changed_.NotifyAll();
    }
    const MutexLock lock(mutex_);
    closed_ = true;
    changed_.NotifyAll();
  }

  void WriteAll(ResendBuffer* buffer, const Fill& fill) {
    while (WaitForRoom()) {
      auto next = buffer->Next();
      if (!next.ok() || *next == nullptr) {
        // Observations sent before the source failed are answered first.
        source_failed_ = !next.ok();
        if (source_failed_) SetError(next.status());
        ended_ = true;
        limit_->Await();
        stream_->WritesDone();
        return;
      }
      Request request;
      fill(**next, &request);
      {
        const MutexLock lock(mutex_);
        ++open_;
      }
      limit_->Await();
      if (!stream_->Write(request)) return;
    }
  }

  // False: the stream is closed.
  bool WaitForRoom() {
    const MutexLock lock(mutex_);
    while (!closed_ && open_ >= window_) changed_.Wait(mutex_);
    return !closed_;
  }

  void SetError(const absl::Status& status) {
    const MutexLock lock(mutex_);
    if (error_.ok()) error_ = status;
  }

  void Fail(const absl::Status& status) {
    SetError(status);
    context_->TryCancel();
  }

  grpc::ClientContext* context_;
  Stream* stream_;
  AnswerLimit* limit_;
  const int window_;
  Mutex mutex_;
  ConditionVariable changed_;
  // Observations sent and not answered.
  int open_ HOMING_GUARDED_BY(mutex_) = 0;
  bool closed_ HOMING_GUARDED_BY(mutex_) = false;
  bool ended_ = false;
  bool source_failed_ = false;
  absl::Status error_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::client

#endif  // CLIENT_EXCHANGE_H_
