// Converts SQLite's result codes to absl::Status. No other place does.
#ifndef STORAGE_SQLITE_STATUS_H_
#define STORAGE_SQLITE_STATUS_H_

#include <SQLiteCpp/SQLiteCpp.h>

#include <string>

#include "absl/status/status.h"

namespace homing::storage {

// `code` is a primary or extended result code of SQLite other than SQLITE_OK.
absl::Status StatusFromSqlite(int code, const std::string& message);
absl::Status StatusFromException(const SQLite::Exception& exception);
// A fault of the store that SQLite did not report.
absl::Status StoreFault(absl::StatusCode code, const std::string& message);
// True if `status` was made here for a fault of the store (full, unreadable, locked), not of the
// request.
bool IsStoreFault(const absl::Status& status);

}  // namespace homing::storage

#endif  // STORAGE_SQLITE_STATUS_H_
