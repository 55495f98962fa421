// Rows of `deviation_models` in PostgreSQL.
#ifndef STORAGE_POSTGRES_PG_MODEL_ROWS_H_
#define STORAGE_POSTGRES_PG_MODEL_ROWS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "storage/journey_store.h"
#include "storage/postgres/pg_connection.h"

namespace homing::storage::postgres {

// ALREADY_EXISTS.
absl::Status InsertModel(PgConnection& connection, const StoredModel& model, Deadline deadline);
// NOT_FOUND, DATA_LOSS.
absl::StatusOr<StoredModel> FindModel(PgConnection& connection, const std::string& name,
                                      Deadline deadline);
absl::StatusOr<std::vector<StoredModel>> ListModelRows(PgConnection& connection,
                                                       const std::string& after, int limit,
                                                       Deadline deadline);

}  // namespace homing::storage::postgres

#endif  // STORAGE_POSTGRES_PG_MODEL_ROWS_H_
