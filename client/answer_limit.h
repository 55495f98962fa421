// Cancels a stream whose server is connected and does not answer.
#ifndef CLIENT_ANSWER_LIMIT_H_
#define CLIENT_ANSWER_LIMIT_H_

#include <grpcpp/client_context.h>

#include <chrono>
#include <thread>

#include "absl/status/status.h"
#include "homing/base/mutex.h"

namespace homing::client {

// Thread-safe.
class AnswerLimit {
 public:
  // REQUIRES: `context` outlives it.
  AnswerLimit(grpc::ClientContext* context, std::chrono::milliseconds limit);
  ~AnswerLimit();

  // One more answer, or the end of the stream, is awaited.
  void Await();
  // An answer was read. The time until Continue is not the server's.
  void Answered();
  void Continue();
  // UNAVAILABLE: no answer came for `limit` while one was awaited, and the stream was cancelled;
  // else `status`.
  absl::Status Explain(const absl::Status& status) const;

 private:
  using Clock = std::chrono::steady_clock;
  void Watch();

  grpc::ClientContext* const context_;
  const std::chrono::milliseconds limit_;
  mutable Mutex mutex_;
  ConditionVariable changed_;
  int awaited_ HOMING_GUARDED_BY(mutex_) = 0;
  bool is_reading_ HOMING_GUARDED_BY(mutex_) = true;
  // The last answer, or where none was awaited, the last Await.
  Clock::time_point since_ HOMING_GUARDED_BY(mutex_);
  bool ended_ HOMING_GUARDED_BY(mutex_) = false;
  bool expired_ HOMING_GUARDED_BY(mutex_) = false;
  // Last: it uses all of the above.
  std::thread thread_;
};

}  // namespace homing::client

#endif  // CLIENT_ANSWER_LIMIT_H_
