// The errors that all stores share, with one wording for each.
#ifndef STORAGE_STORE_ERRORS_H_
#define STORAGE_STORE_ERRORS_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace homing::storage {

inline absl::Status ReadOnlyError() {
  return absl::FailedPreconditionError(
      "store: it is read-only (--readonly): nothing can be recorded, changed or deleted");
}

inline absl::Status JourneyNotFound(const std::string& name) {
  return absl::NotFoundError(absl::StrCat("journey '", name, "' does not exist"));
}

inline absl::Status JourneyExists(const std::string& name) {
  return absl::AlreadyExistsError(absl::StrCat("journey '", name, "' already exists"));
}

inline absl::Status JourneyIsFinished(const std::string& name) {
  return absl::FailedPreconditionError(absl::StrCat("journey '", name, "' is finished"));
}

inline absl::Status ModelNotFound(const std::string& name) {
  return absl::NotFoundError(absl::StrCat("deviation model '", name, "' does not exist"));
}

inline absl::Status ModelExists(const std::string& name) {
  return absl::AlreadyExistsError(absl::StrCat("deviation model '", name, "' already exists"));
}

// FAILED_PRECONDITION if the tables' `version` is not in [0, `own`], `own` being this program's.
inline absl::Status CheckNotNewer(std::int64_t version, std::int64_t own) {
  if (version >= 0 && version <= own) return absl::OkStatus();
  return absl::FailedPreconditionError(absl::StrCat("store: schema version is ", version,
                                                    ", newer than this program's ", own,
                                                    ": use a newer homing-server"));
}

// FAILED_PRECONDITION also if the version is older.
inline absl::Status CheckSameVersion(std::int64_t version, std::int64_t own) {
  if (version < 0 || version >= own) return CheckNotNewer(version, own);
  return absl::FailedPreconditionError(
      absl::StrCat("store: schema version is ", version, ", older than this program's ", own,
                   ": start homing-server on it once, not read-only, to migrate it"));
}

}  // namespace homing::storage

#endif  // STORAGE_STORE_ERRORS_H_
