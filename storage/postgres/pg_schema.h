// The tables in PostgreSQL and their versions (docs/storage-format.md).
#ifndef STORAGE_POSTGRES_PG_SCHEMA_H_
#define STORAGE_POSTGRES_PG_SCHEMA_H_

#include "absl/status/status.h"
#include "storage/postgres/pg_connection.h"
#include "storage/postgres_store.h"

namespace homing::storage::postgres {

// Makes the tables of an empty database, or migrates those of an older version, in one transaction;
// servers that start together wait for each other. FAILED_PRECONDITION: a newer version.
absl::Status Migrate(PgConnection& connection, Deadline deadline);
// FAILED_PRECONDITION: another version.
absl::Status CheckSchema(PgConnection& connection, Deadline deadline);

}  // namespace homing::storage::postgres

#endif  // STORAGE_POSTGRES_PG_SCHEMA_H_
