// Rows of `steps`: one row holds one step of a journey. All functions run in the body of a
// transaction and throw SQLite::Exception, which ends the transaction.
#ifndef STORAGE_STEP_ROWS_H_
#define STORAGE_STEP_ROWS_H_

#include <cstdint>
#include <optional>

#include "absl/status/statusor.h"
#include "homing/journey/journey_map.h"
#include "storage/connection.h"

namespace homing::storage {

// REQUIRES: left before right, at most two on a side.
void InsertStep(Connection& connection, std::int64_t journey_id, const JourneyStep& step);

// JourneyStep::sequence of the last step below `step_count`; -1: there is no step.
std::int64_t FindLastSequence(Connection& connection, std::int64_t journey_id,
                              std::int64_t step_count);

// Selects the rows from `first` on, in order; ReadStep reads the current one.
Query SelectSteps(Connection& connection, std::int64_t journey_id, std::int64_t first);
// INVALID_ARGUMENT: a flow profile of another form.
absl::StatusOr<JourneyStep> ReadStep(Query& row);

// The side of a landmark, searched from the last step backwards; none: no step holds it. It usually
// reads few rows.
std::optional<Side> FindSide(Connection& connection, std::int64_t journey_id,
                             std::int32_t landmark);

}  // namespace homing::storage

#endif  // STORAGE_STEP_ROWS_H_
