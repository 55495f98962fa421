// What a client sends: numbered observations, as messages.
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
  // Numbered from 0 without gaps. Nothing at the end.
  virtual absl::StatusOr<std::optional<v1::Observation>> Next() = 0;
  // Makes `sequence` the next one, the same as the first time (beyond the end: nothing is next).
  // False: cannot go back (live camera).
  virtual bool Seek(std::int64_t sequence) = 0;
  // What comes next is new: numbers it `sequence` and marks that a break is before it.
  virtual void ContinueAt(std::int64_t sequence) = 0;
};

}  // namespace homing::client

#endif  // CLIENT_OBSERVATION_STREAM_H_
