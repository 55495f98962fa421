#include "storage/sqlite_status.h"

#include <sqlite3.h>

#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"

namespace homing::storage {
namespace {

constexpr char kFaultUrl[] = "homing/store-fault";

absl::StatusCode ConstraintCode(int extended) {
  switch (extended) {
    case SQLITE_CONSTRAINT_UNIQUE:
    case SQLITE_CONSTRAINT_PRIMARYKEY:
    case SQLITE_CONSTRAINT_ROWID:
      return absl::StatusCode::kAlreadyExists;
    case SQLITE_CONSTRAINT_CHECK:
    case SQLITE_CONSTRAINT_NOTNULL:
    case SQLITE_CONSTRAINT_DATATYPE:
      return absl::StatusCode::kInvalidArgument;
    default:
      return absl::StatusCode::kInternal;
  }
}

// The disk may answer later: the caller should retry.
absl::StatusCode IoErrorCode(int extended) {
  switch (extended) {
    case SQLITE_IOERR_NOMEM:
    // The index of the log needs more space.
    case SQLITE_IOERR_SHMSIZE:
      return absl::StatusCode::kResourceExhausted;
    // A checksum is wrong. (EIO on a read becomes SQLITE_IOERR_CORRUPTFS.)
    case SQLITE_IOERR_DATA:
      return absl::StatusCode::kDataLoss;
    default:
      return absl::StatusCode::kUnavailable;
  }
}

bool IsFault(int code) {
  const int primary = code & 0xff;
  return primary != SQLITE_CONSTRAINT && primary != SQLITE_TOOBIG && primary != SQLITE_INTERRUPT;
}

absl::StatusCode CodeOf(int code) {
  // The low byte is the primary code.
  switch (code & 0xff) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
    case SQLITE_PROTOCOL:
    case SQLITE_SCHEMA:
      return absl::StatusCode::kUnavailable;
    case SQLITE_CONSTRAINT:
      return ConstraintCode(code);
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return absl::StatusCode::kDataLoss;
    case SQLITE_FULL:
    case SQLITE_NOMEM:
    case SQLITE_TOOBIG:
      return absl::StatusCode::kResourceExhausted;
    case SQLITE_IOERR:
      return IoErrorCode(code);
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
    case SQLITE_AUTH:
      return absl::StatusCode::kFailedPrecondition;
    case SQLITE_INTERRUPT:
      return absl::StatusCode::kCancelled;
    default:
      return absl::StatusCode::kInternal;
  }
}

}  // namespace

absl::Status StatusFromSqlite(int code, const std::string& message) {
  absl::Status status(CodeOf(code), absl::StrCat("store: ", message, " (SQLite code ", code, ")"));
  if (IsFault(code)) status.SetPayload(kFaultUrl, absl::Cord(absl::StrCat(code)));
  return status;
}

absl::Status StoreFault(absl::StatusCode code, const std::string& message) {
  absl::Status status(code, message);
  status.SetPayload(kFaultUrl, absl::Cord("0"));
  return status;
}

bool IsStoreFault(const absl::Status& status) { return status.GetPayload(kFaultUrl).has_value(); }

absl::Status StatusFromException(const SQLite::Exception& exception) {
  const int extended = exception.getExtendedErrorCode();
  return StatusFromSqlite(extended > 0 ? extended : exception.getErrorCode(), exception.what());
}

}  // namespace homing::storage
