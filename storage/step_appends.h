// Appending steps to `journeys` and `steps`. Used in the body of a transaction;
// throws SQLite::Exception, which ends the transaction.
#ifndef STORAGE_STEP_APPENDS_H_
#define STORAGE_STEP_APPENDS_H_

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "storage/connection.h"
#include "storage/growing_journey.h"
#include "storage/journey_store.h"

namespace homing::storage {

// The appends of successive transactions. A journey's row changes with each append: it is read
// once, written once a transaction, and kept for the next one. Not thread-safe.
class StepAppends {
 public:
  explicit StepAppends(Connection* connection) : connection_(connection) {}

  // After an error nothing of this append is written. NOT_FOUND; errors of Grow.
  absl::Status Append(const JourneyAppend& append);
  // Writes the changed journeys' rows. Call it once a transaction, after the last append.
  void Write();
  // The epoch of the last acquisition; 0: none since the store was opened.
  std::int64_t epoch(const std::string& name) const;
  // Returns a new epoch, larger than any before.
  std::int64_t Acquire(const std::string& name);
  // Call it after a journey was deleted.
  void ForgetEpoch(const std::string& name) { epochs_.erase(name); }
  // Clears the kept rows: a transaction failed, or other code wrote.
  void Forget();

 private:
  absl::StatusOr<GrowingJourney*> Find(const std::string& name);
  void WriteJourney(GrowingJourney& journey);

  Connection* const connection_;
  std::unordered_map<std::string, GrowingJourney> journeys_;
  std::vector<GrowingJourney*> changed_;
  // Epochs are not stored: only one process writes the file, and its appends end with the process.
  std::unordered_map<std::string, std::int64_t> epochs_;
  std::int64_t last_epoch_ = 0;
};

}  // namespace homing::storage

#endif  // STORAGE_STEP_APPENDS_H_
