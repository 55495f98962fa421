// Keeps observations that were sent but not acknowledged, and a few before them, for resending
// after a broken link.
#ifndef CLIENT_RESEND_BUFFER_H_
#define CLIENT_RESEND_BUFFER_H_

#include <cstdint>
#include <deque>
#include <memory>

#include "absl/status/statusor.h"
#include "client/observation_stream.h"
#include "homing/base/mutex.h"

namespace homing::client {

// Thread-safe for one sending thread (Next, Rewind) and one acknowledging thread.
class ResendBuffer {
 public:
  // Keeps `keep` acknowledged observations. `stream` must outlive the buffer.
  ResendBuffer(ObservationStream* stream, int keep);

  // The next observation to send, from the buffer or the stream; null at the end.
  absl::StatusOr<std::shared_ptr<const v1::Observation>> Next();

  // Everything before `sequence` need not be sent again.
  void Acknowledge(std::int64_t sequence);

  // The server has all observations before `durable`. Sends again from `resend_from` <= `durable`,
  // from the buffer or by Seek. A stream that cannot seek continues at `durable` at the latest,
  // with a break. DATA_LOSS: the expected observation is neither kept nor available from the
  // stream.
  absl::Status Rewind(std::int64_t resend_from, std::int64_t durable);

  // Sends all kept observations again. Returns the first sequence.
  std::int64_t RewindAll();

 private:
  std::int64_t begin() const HOMING_REQUIRES(mutex_);
  std::int64_t end() const HOMING_REQUIRES(mutex_);

  Mutex mutex_;
  ObservationStream* stream_;
  int keep_;
  std::deque<std::shared_ptr<const v1::Observation>> kept_ HOMING_GUARDED_BY(mutex_);
  // The sequence that Next returns next; all kept ones before it were sent.
  std::int64_t cursor_ HOMING_GUARDED_BY(mutex_) = 0;
  std::int64_t acknowledged_ HOMING_GUARDED_BY(mutex_) = 0;
};

}  // namespace homing::client

#endif  // CLIENT_RESEND_BUFFER_H_
