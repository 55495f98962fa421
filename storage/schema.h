// Tables of the store and their versions (docs/storage-format.md).
#ifndef STORAGE_SCHEMA_H_
#define STORAGE_SCHEMA_H_

#include <cstdint>

#include "absl/status/status.h"
#include "storage/connection.h"

namespace homing::storage {

// `PRAGMA application_id`: "HOMI".
inline constexpr std::int64_t kApplicationId = 0x484F4D49;
// `PRAGMA user_version` that this program writes.
inline constexpr std::int64_t kSchemaVersion = 4;

// Creates the tables in an empty file, or migrates those of an older version, in one transaction.
// FAILED_PRECONDITION: a newer version, or another program's file.
absl::Status Migrate(Connection& connection);

// Runs without a transaction. FAILED_PRECONDITION: another program's file, or a newer version.
absl::Status CheckOwnFile(Connection& connection);

// Checks a file that must not change. FAILED_PRECONDITION: another version, or another program's
// file.
absl::Status CheckSchema(Connection& connection);

// Call it in a body. Rewrites the stored version: writes one page without a change.
absl::Status TouchSchemaVersion(Connection& connection);

}  // namespace homing::storage

#endif  // STORAGE_SCHEMA_H_
