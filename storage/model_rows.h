// Rows of the table `deviation_models`. Used in the body of a transaction; throws
// SQLite::Exception, which ends the transaction.
#ifndef STORAGE_MODEL_ROWS_H_
#define STORAGE_MODEL_ROWS_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "storage/connection.h"
#include "storage/journey_store.h"

namespace homing::storage {

// ALREADY_EXISTS.
absl::Status InsertModel(Connection& connection, const StoredModel& model);
// NOT_FOUND, DATA_LOSS.
absl::StatusOr<StoredModel> FindModel(Connection& connection, const std::string& name);
absl::StatusOr<std::vector<StoredModel>> ListModelRows(Connection& connection,
                                                       const std::string& after, int limit);

}  // namespace homing::storage

#endif  // STORAGE_MODEL_ROWS_H_
