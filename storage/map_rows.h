// Whole maps from and to the rows of `steps`. Used in the body of a
// transaction; throws SQLite::Exception, which ends the transaction.
#ifndef STORAGE_MAP_ROWS_H_
#define STORAGE_MAP_ROWS_H_

#include "absl/status/statusor.h"
#include "homing/journey/journey_map.h"
#include "storage/connection.h"
#include "storage/journey_rows.h"

namespace homing::storage {

// DATA_LOSS: the rows contradict each other.
absl::StatusOr<JourneyMap> ReadMap(Connection& connection, const JourneyRow& journey);
// The steps from `first` on that have a row. DATA_LOSS.
absl::StatusOr<std::vector<JourneyStep>> ReadSteps(Connection& connection,
                                                   const JourneyRow& journey, std::int64_t first);
// As JourneyStore::LoadTail. DATA_LOSS.
absl::StatusOr<JourneyTail> ReadTail(Connection& connection, const JourneyRow& journey);
// Writes all rows of a journey that has none.
void WriteMap(Connection& connection, std::int64_t journey_id, const JourneyMap& map);

}  // namespace homing::storage

#endif  // STORAGE_MAP_ROWS_H_
