// Observations that carry nothing but their number.
#ifndef TESTS_CLIENT_NUMBERED_STREAM_H_
#define TESTS_CLIENT_NUMBERED_STREAM_H_

#include <vector>

#include "client/observation_stream.h"

namespace homing::client {

class NumberedStream : public ObservationStream {
 public:
  // `live`: cannot go back.
  explicit NumberedStream(std::int64_t count, bool live = false) : count_(count), live_(live) {}

  absl::StatusOr<std::optional<v1::Observation>> Next() override;
  bool Seek(std::int64_t sequence) override;
  void ContinueAt(std::int64_t sequence) override;

  // Arguments of all Seek calls.
  const std::vector<std::int64_t>& seeks() const { return seeks_; }

 private:
  std::int64_t count_;
  bool live_;
  std::int64_t next_ = 0;
  // A live camera gives `count_` frames whatever they are numbered.
  std::int64_t given_ = 0;
  bool break_ = false;
  std::vector<std::int64_t> seeks_;
};

}  // namespace homing::client

#endif  // TESTS_CLIENT_NUMBERED_STREAM_H_
