// Statuses of PostgreSQL's errors. See appendix A of its manual.
#ifndef STORAGE_POSTGRES_PG_STATUS_H_
#define STORAGE_POSTGRES_PG_STATUS_H_

#include <libpq-fe.h>

#include <string>

#include "absl/status/status.h"

namespace homing::storage::postgres {

// Of a statement that failed: UNAVAILABLE (try again), RESOURCE_EXHAUSTED (disk full, no memory),
// DATA_LOSS, FAILED_PRECONDITION (no right, read-only), INTERNAL.
absl::Status StatusOfResult(const PGresult* result);
// Of a five-character code.
absl::Status StatusOfCode(const std::string& code, const std::string& message);
// Of a connection that was refused. libpq gives no code for it.
absl::Status StatusOfConnection(const std::string& message);
// The server ends the connection with this error.
bool IsFatal(const PGresult* result);
// The transaction was rolled back because of another one; it may be tried again at once.
bool IsConflict(const absl::Status& status);

}  // namespace homing::storage::postgres

#endif  // STORAGE_POSTGRES_PG_STATUS_H_
