// Rows of `steps`: what was seen at one step of a journey, all of it in one row. Used in the body
// of a transaction; throws SQLite::Exception, which ends the transaction.
#ifndef STORAGE_STEP_ROWS_H_
#define STORAGE_STEP_ROWS_H_

#include <cstdint>
#include <map>

#include "absl/status/statusor.h"
#include "homing/journey/journey_map.h"
#include "storage/connection.h"

namespace homing::storage {

// Nothing for a step without fingerprints and flow profiles. REQUIRES: left before right, at most
// two on a side.
void InsertStep(Connection& connection, std::int64_t journey_id, const JourneyStep& step);

// The rows from `first` on, in order; ReadStep takes the one that it stands on.
Query SelectSteps(Connection& connection, std::int64_t journey_id, std::int64_t first);
// INVALID_ARGUMENT: no flow profile that this program writes.
absl::StatusOr<JourneyStep> ReadStep(Query& row);

// Adds the sides of landmarks, from the last step backwards until that of `landmark` is known; all,
// if it is in no step. As a rule one row is read.
void FindSides(Connection& connection, std::int64_t journey_id, std::int32_t landmark,
               std::map<std::int32_t, Side>& sides);

}  // namespace homing::storage

#endif  // STORAGE_STEP_ROWS_H_
