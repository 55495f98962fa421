// Observations sent and not yet acknowledged, and those before them that are needed again after a
// broken link. Source: own design.
#ifndef CLIENT_RESEND_BUFFER_H_
#define CLIENT_RESEND_BUFFER_H_

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>

#include "absl/status/statusor.h"
#include "client/observation_stream.h"

namespace homing::client {

// One thread sends (Next, Rewind), another acknowledges: thread-safe.
class ResendBuffer {
 public:
  // Keeps `keep` more observations that are acknowledged already. `stream` must outlive the buffer.
  ResendBuffer(ObservationStream* stream, int keep);

  // The next observation to send, from the buffer or the stream; null at the end.
  absl::StatusOr<std::shared_ptr<const v1::Observation>> Next();

  // Everything before `sequence` need not be sent again, but for the last `keep`.
  void Acknowledge(std::int64_t sequence);
  // Everything before `sequence` need not be sent again, but for `reference`, and the last `keep`
  // before that.
  void Acknowledge(std::int64_t sequence, std::int64_t reference);

  // The server has all before `durable`: sends `resend_from` <= `durable` again and then all that
  // is kept from there on, or goes back by Seek. A stream that cannot go back goes on at `durable`
  // at the latest, with a break. DATA_LOSS: what is due is neither kept nor can it be had again.
  absl::Status Rewind(std::int64_t resend_from, std::int64_t durable);

  // Sends again all that is kept. The sequence it begins with.
  std::int64_t RewindAll();

 private:
  using Kept = std::deque<std::shared_ptr<const v1::Observation>>;

  // Sequence after the last one kept.
  std::int64_t end() const;
  // The first kept of at least `sequence`.
  std::size_t IndexOf(std::int64_t sequence) const;
  bool Has(std::int64_t sequence) const;
  // Those before `first`, and those from `after` to before `sequence`.
  void Drop(std::int64_t first, std::int64_t after, std::int64_t sequence);

  std::mutex mutex_;
  ObservationStream* stream_;
  int keep_;
  // In order of sequence. Only acknowledged ones are missing between two.
  Kept kept_;
  // Index in kept_ of what Next gives next; all kept before it were sent.
  std::size_t cursor_ = 0;
  // Sequence that the stream gives next.
  std::int64_t next_ = 0;
  std::int64_t acknowledged_ = 0;
};

}  // namespace homing::client

#endif  // CLIENT_RESEND_BUFFER_H_
