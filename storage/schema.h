// Tables of the store and their versions (docs/storage-format.md). Source: own design.
#ifndef STORAGE_SCHEMA_H_
#define STORAGE_SCHEMA_H_

#include <cstdint>

#include "absl/status/status.h"
#include "storage/connection.h"

namespace homing::storage {

// `PRAGMA application_id`: "HOMI".
inline constexpr std::int64_t kApplicationId = 0x484F4D49;
// `PRAGMA user_version` that this program writes.
inline constexpr std::int64_t kSchemaVersion = 2;

// Makes the tables of an empty file, or brings those of an older version up to date, in one
// transaction. FAILED_PRECONDITION: a newer version, or another program's file.
absl::Status Migrate(Connection& connection);

}  // namespace homing::storage

#endif  // STORAGE_SCHEMA_H_
