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
// `status` was made here, and the store is at fault (full, unreadable, locked), not the request.
bool IsStoreFault(const absl::Status& status);

}  // namespace homing::storage

#endif  // STORAGE_SQLITE_STATUS_H_
