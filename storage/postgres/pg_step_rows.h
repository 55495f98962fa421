// Rows of `steps` in PostgreSQL: one row holds one step of a journey.
#ifndef STORAGE_POSTGRES_PG_STEP_ROWS_H_
#define STORAGE_POSTGRES_PG_STEP_ROWS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "homing/journey/journey_map.h"
#include "storage/map_assembly.h"
#include "storage/postgres/pg_connection.h"

namespace homing::storage::postgres {

// The columns of many steps.
struct StepColumns {
  std::vector<std::int64_t> journey_ids;
  std::vector<std::int64_t> steps;
  // kNextSequence: NULL.
  std::vector<std::int64_t> sequences;
  std::vector<std::optional<std::string>> fingerprints;
  std::vector<std::optional<std::string>> left_profiles;
  std::vector<std::optional<std::string>> right_profiles;

  void Add(std::int64_t journey_id, const JourneyStep& step);
  void Clear() { *this = {}; }
  // Adds the six arrays.
  void AddTo(PgArguments* arguments) const;
};

std::string EncodeFingerprints(const std::vector<RecordedFingerprint>& fingerprints);
// DATA_LOSS: another form.
absl::StatusOr<std::vector<RecordedFingerprint>> DecodeFingerprints(const std::string& bytes);

// The rows from `first` on, in order.
absl::StatusOr<PgRows> SelectSteps(PgConnection& connection, std::int64_t journey_id,
                                   std::int64_t first, Deadline deadline);
// Reads the rows of SelectSteps one after the other. `rows` must outlive it.
StepReader ReaderOf(const PgRows& rows);

// JourneyStep::sequence of the last step below `step_count`; -1: there is no step.
absl::StatusOr<std::int64_t> FindLastSequence(PgConnection& connection, std::int64_t journey_id,
                                              std::int64_t step_count, Deadline deadline);
// The side of a landmark, searched from the last step backwards; none: no step holds it.
absl::StatusOr<std::optional<Side>> FindSide(PgConnection& connection, std::int64_t journey_id,
                                             std::int32_t landmark, Deadline deadline);
// Writes all rows of a journey that has none.
absl::Status InsertMap(PgConnection& connection, std::int64_t journey_id, const JourneyMap& map,
                       Deadline deadline);

}  // namespace homing::storage::postgres

#endif  // STORAGE_POSTGRES_PG_STEP_ROWS_H_
