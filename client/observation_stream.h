// The numbered observations that a client sends, as messages.
#ifndef CLIENT_OBSERVATION_STREAM_H_
#define CLIENT_OBSERVATION_STREAM_H_

#include <cstdint>
#include <optional>

#include "absl/status/statusor.h"
#include "homing/v1/types.pb.h"

namespace homing::client {

// Not thread-safe.
class ObservationStream {
 public:
  virtual ~ObservationStream() = default;
  // Numbered from 0 without gaps. std::nullopt at the end.
  virtual absl::StatusOr<std::optional<v1::Observation>> Next() = 0;
  // The frame that made the last step of the journey; -1: none, or not known. A stream of flow
  // vectors continues from it at the next Seek or ContinueAt.
  virtual void set_last_frame(std::int64_t) {}
  // Makes `sequence` the next observation, identical to the first time (beyond the end: none
  // follows). False: not possible (live camera).
  virtual bool Seek(std::int64_t sequence) = 0;
  // Continues with new observations: the next one has the number `sequence` and is marked as a
  // break.
  virtual void ContinueAt(std::int64_t sequence) = 0;
};

}  // namespace homing::client

#endif  // CLIENT_OBSERVATION_STREAM_H_
