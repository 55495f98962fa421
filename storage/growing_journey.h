// The rules of appending, which do not depend on the database: whether an append continues its
// journey, and how the journey's row changes.
#ifndef STORAGE_GROWING_JOURNEY_H_
#define STORAGE_GROWING_JOURNEY_H_

#include <cstdint>
#include <functional>
#include <map>
#include <optional>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "storage/journey_store.h"

namespace homing::storage {

// The part of a row of `journeys` that appending needs.
struct GrowingJourney {
  std::int64_t id = 0;
  std::int64_t epoch = 0;
  JourneyState state = JourneyState::kActive;
  InputKind input = InputKind::kUnknown;
  std::int64_t next_sequence = 0;
  std::int64_t resend_from = 0;
  std::int64_t step_count = 0;
  // JourneyStep::sequence of the last step; -1: none.
  std::int64_t last_sequence = -1;
  std::int32_t landmark_count = 0;
  struct SeenLandmark {
    Side side = Side::kLeft;
    // The last step that holds it, or a later one.
    std::int64_t step = 0;
  };
  // All landmarks that a tracker may still find again, and some others.
  std::map<std::int32_t, SeenLandmark> seen;
  // The members below count since the transaction began; times are 0 if none.
  std::int64_t first_time_ns = 0;
  std::int64_t last_time_ns = 0;
  std::int64_t new_fingerprints = 0;
  std::optional<JourneySettings> new_settings;
  bool is_changed = false;
};

// The side of a landmark in the stored steps of the journey; none: no step holds it.
using SideFinder =
    std::function<absl::StatusOr<std::optional<Side>>(const GrowingJourney&, std::int32_t)>;

// Checks everything first; after an error the journey is as before. FAILED_PRECONDITION (finished,
// other input), ABORTED (another epoch), OUT_OF_RANGE (the sequence is not the next),
// INVALID_ARGUMENT (the step does not continue the journey), DATA_LOSS.
absl::Status Grow(GrowingJourney& journey, const JourneyAppend& append, const SideFinder& find);

// Makes the same changes in a record in memory. REQUIRES: the append was stored.
void GrowRecord(JourneyRecord& record, const JourneyAppend& append);

// Call it after the journey's row was written.
void MarkWritten(GrowingJourney& journey);

}  // namespace homing::storage

#endif  // STORAGE_GROWING_JOURNEY_H_
