// Appending steps to `journeys`, `landmarks` and `fingerprints`. Used in the body of a transaction;
// throws SQLite::Exception, which ends the transaction. Source: own design.
#ifndef STORAGE_STEP_ROWS_H_
#define STORAGE_STEP_ROWS_H_

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "storage/connection.h"
#include "storage/journey_store.h"

namespace homing::storage {

// Appends of one transaction, many of them to the same journeys: what they change again and again,
// a journey's and a landmark's row, is read once and written once.
class StepAppends {
 public:
  explicit StepAppends(Connection* connection) : connection_(connection) {}

  // Checks all first; after an error nothing of this append is written. NOT_FOUND,
  // FAILED_PRECONDITION (finished, other input), OUT_OF_RANGE (sequence not next), INVALID_ARGUMENT
  // (a step that does not continue the journey).
  absl::Status Append(const JourneyAppend& append);
  // The rows that were held back. Once, after the last append.
  void Write();

 private:
  // A row of `landmarks`.
  struct LandmarkRow {
    Landmark landmark;
    bool is_new = false;
    bool is_changed = false;
  };
  // A row of `journeys`, as far as appending needs it.
  struct JourneyColumns {
    std::int64_t id = 0;
    JourneyState state = JourneyState::kActive;
    InputKind input = InputKind::kUnknown;
    std::int64_t next_sequence = 0;
    std::int64_t step_count = 0;
    std::int32_t landmark_count = 0;
    // Since the transaction began: times are 0 if none.
    std::int64_t first_time_ns = 0;
    std::int64_t last_time_ns = 0;
    std::int64_t new_fingerprints = 0;
    std::optional<JourneySettings> new_settings;
    bool is_changed = false;
    std::map<std::int32_t, LandmarkRow> landmarks;
  };

  absl::StatusOr<JourneyColumns*> Find(const std::string& name);
  // Null: it has no row.
  absl::StatusOr<LandmarkRow*> FindLandmark(JourneyColumns& journey, std::int32_t landmark);
  absl::Status CheckLandmark(JourneyColumns& journey, const RecordedFingerprint& recorded,
                             std::set<std::int32_t>& seen);
  absl::Status CheckStep(JourneyColumns& journey, const JourneyStep& step, std::int64_t sequence);
  static absl::Status CheckContinues(const JourneyColumns& journey, const JourneyAppend& append);
  void AddFingerprint(JourneyColumns& journey, std::int64_t step, int index,
                      const RecordedFingerprint& recorded);
  void WriteJourney(const JourneyColumns& journey);

  Connection* const connection_;
  std::map<std::string, JourneyColumns> journeys_;
};

void InsertLandmark(Connection& connection, std::int64_t journey_id, std::int32_t number,
                    const Landmark& landmark);

// Nothing for a profile that is all 0.
void WriteProfile(Connection& connection, std::int64_t journey_id, std::int64_t step, Side side,
                  const FlowProfile& profile);

}  // namespace homing::storage

#endif  // STORAGE_STEP_ROWS_H_
