// Keeps observations that were sent but not acknowledged, and those before them that are needed
// again after a broken link.
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

  // Everything before `sequence` need not be sent again, but for the last `keep`.
  void Acknowledge(std::int64_t sequence);
  // Everything before `sequence` need not be sent again, but for `reference`, and the last `keep`
  // before that.
  void Acknowledge(std::int64_t sequence, std::int64_t reference);

  // The server has all observations before `durable`. Sends `resend_from` <= `durable` again and
  // then all kept observations from `durable` on, or seeks. A stream that cannot seek continues at
  // `durable` at the latest, with a break. DATA_LOSS: the expected observation is neither kept nor
  // available from the stream.
  absl::Status Rewind(std::int64_t resend_from, std::int64_t durable);

  // Sends all kept observations from `sequence` on again. Returns the first one's sequence.
  std::int64_t RewindTo(std::int64_t sequence);

  // The sequence after the last one that was sent, or that the server had before. No honest answer
  // goes beyond it.
  std::int64_t sent() const;

 private:
  using Kept = std::deque<std::shared_ptr<const v1::Observation>>;

  // The sequence after the last one kept.
  std::int64_t end() const HOMING_REQUIRES(mutex_);
  // Index in kept_ of the first one of at least `sequence`.
  std::size_t IndexOf(std::int64_t sequence) const HOMING_REQUIRES(mutex_);
  bool Has(std::int64_t sequence) const HOMING_REQUIRES(mutex_);
  // Drops the ones before `first`, and the ones from `after` to before `sequence`.
  void Drop(std::int64_t first, std::int64_t after, std::int64_t sequence) HOMING_REQUIRES(mutex_);

  mutable Mutex mutex_;
  ObservationStream* stream_;
  int keep_;
  // In order of sequence. Only acknowledged ones are missing between two.
  Kept kept_ HOMING_GUARDED_BY(mutex_);
  // Index in kept_ of the next result of Next; all kept before it were sent.
  std::size_t cursor_ HOMING_GUARDED_BY(mutex_) = 0;
  // The sequence that the stream gives next.
  std::int64_t next_ HOMING_GUARDED_BY(mutex_) = 0;
  std::int64_t acknowledged_ HOMING_GUARDED_BY(mutex_) = 0;
  std::int64_t sent_ HOMING_GUARDED_BY(mutex_) = 0;
};

}  // namespace homing::client

#endif  // CLIENT_RESEND_BUFFER_H_
