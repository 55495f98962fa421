// Appending steps to `journeys`, `landmarks` and `fingerprints`. Used in the body of a transaction;
// throws SQLite::Exception, which ends the transaction. Source: own design.
#ifndef STORAGE_STEP_ROWS_H_
#define STORAGE_STEP_ROWS_H_

#include "absl/status/status.h"
#include "storage/connection.h"
#include "storage/journey_store.h"

namespace homing::storage {

// Checks all first; after an error nothing is written. NOT_FOUND, FAILED_PRECONDITION (finished,
// other input), OUT_OF_RANGE (sequence not next), INVALID_ARGUMENT (a step that does not continue
// the journey).
absl::Status AppendStep(Connection& connection, const JourneyAppend& append);

// Nothing for a profile that is all 0.
void WriteProfile(Connection& connection, std::int64_t journey_id, std::int64_t step, Side side,
                  const FlowProfile& profile);

}  // namespace homing::storage

#endif  // STORAGE_STEP_ROWS_H_
