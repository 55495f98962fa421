// Appending steps to `journeys` and `steps`. Used in the body of a transaction;
// throws SQLite::Exception, which ends the transaction.
#ifndef STORAGE_STEP_APPENDS_H_
#define STORAGE_STEP_APPENDS_H_

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "storage/connection.h"
#include "storage/journey_store.h"

namespace homing::storage {

// The appends of successive transactions. A journey's row changes with each append: it is read
// once, written once a transaction, and kept for the next one.
class StepAppends {
 public:
  explicit StepAppends(Connection* connection) : connection_(connection) {}

  // Checks everything first; after an error nothing of this append is written. NOT_FOUND,
  // FAILED_PRECONDITION (finished, other input), OUT_OF_RANGE (the sequence is not the next),
  // INVALID_ARGUMENT (the step does not continue the journey).
  absl::Status Append(const JourneyAppend& append);
  // Writes the changed journeys' rows. Call it once a transaction, after the last append.
  void Write();
  // Clears the kept rows: a transaction failed, or other code wrote.
  void Forget();

 private:
  // The part of a row of `journeys` that appending needs.
  struct JourneyColumns {
    std::int64_t id = 0;
    JourneyState state = JourneyState::kActive;
    InputKind input = InputKind::kUnknown;
    std::int64_t next_sequence = 0;
    std::int64_t resend_from = 0;
    std::int64_t step_count = 0;
    // JourneyStep::sequence of the last step; -1: none.
    std::int64_t last_sequence = -1;
    std::int32_t landmark_count = 0;
    // The landmarks of the last step, and some others.
    std::map<std::int32_t, Side> sides;
    // The members below count since the transaction began; times are 0 if none.
    std::int64_t first_time_ns = 0;
    std::int64_t last_time_ns = 0;
    std::int64_t new_fingerprints = 0;
    std::optional<JourneySettings> new_settings;
    bool is_changed = false;
  };

  absl::StatusOr<JourneyColumns*> Find(const std::string& name);
  // DATA_LOSS: no step holds it.
  absl::StatusOr<Side> SideOf(JourneyColumns& journey, std::int32_t landmark);
  absl::Status CheckLandmark(JourneyColumns& journey, const RecordedFingerprint& recorded,
                             std::set<std::int32_t>& seen);
  absl::Status CheckStep(JourneyColumns& journey, const JourneyStep& step, std::int64_t sequence);
  static absl::Status CheckContinues(const JourneyColumns& journey, const JourneyAppend& append);
  void AddStep(JourneyColumns& journey, const JourneyAppend& append);
  void WriteJourney(JourneyColumns& journey);

  Connection* const connection_;
  std::unordered_map<std::string, JourneyColumns> journeys_;
  std::vector<JourneyColumns*> changed_;
};

}  // namespace homing::storage

#endif  // STORAGE_STEP_APPENDS_H_
