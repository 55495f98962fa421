// Statuses of PostgreSQL's errors. See appendix A of its manual.
#ifndef STORAGE_POSTGRES_PG_STATUS_H_
#define STORAGE_POSTGRES_PG_STATUS_H_

#include <libpq-fe.h>

#include <string>

#include "absl/status/status.h"

namespace homing::storage::postgres {

// The status of a failed statement: UNAVAILABLE (try again), RESOURCE_EXHAUSTED (disk full, no
// memory), DATA_LOSS, FAILED_PRECONDITION (no right, read-only), INTERNAL.
absl::Status StatusOfResult(const PGresult* result);
// The status of a five-character SQLSTATE code.
absl::Status StatusOfCode(const std::string& code, const std::string& message);
// The status of a refused connection, by libpq's text: there is no code.
absl::Status StatusOfConnection(const std::string& message);
// True if the server ends the connection with this error.
bool IsFatal(const PGresult* result);
// The transaction was rolled back because of another one; it may be tried again at once.
bool IsConflict(const absl::Status& status);

}  // namespace homing::storage::postgres

#endif  // STORAGE_POSTGRES_PG_STATUS_H_
