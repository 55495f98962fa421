#include "tests/client/numbered_stream.h"

#include <utility>

namespace homing::client {

absl::StatusOr<std::optional<v1::Observation>> NumberedStream::Next() {
  if ((live_ ? given_ : next_) >= count_) return std::optional<v1::Observation>();
  ++given_;
  v1::Observation observation;
  observation.set_sequence(next_++);
  observation.set_break_before(std::exchange(break_, false));
  return std::make_optional(observation);
}

bool NumberedStream::Seek(std::int64_t sequence) {
  seeks_.push_back(sequence);
  if (live_) return false;
  next_ = sequence;
  return true;
}

void NumberedStream::ContinueAt(std::int64_t sequence) {
  next_ = sequence;
  break_ = true;
}

}  // namespace homing::client
