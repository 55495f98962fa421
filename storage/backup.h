// A copy of a database as of one moment, made while a server uses it. Source: SQLite's backup API.
#ifndef STORAGE_BACKUP_H_
#define STORAGE_BACKUP_H_

#include <istream>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace homing::storage {

// Makes the file `to`: complete, checked and durable, or not at all. Writers continue meanwhile.
// ALREADY_EXISTS; FAILED_PRECONDITION: no such file, another program's file, or a newer version;
// DATA_LOSS: the original is damaged; RESOURCE_EXHAUSTED: disk full.
absl::Status BackUp(const std::string& path, const std::string& to);

// A copy that is read once. The file `by` is created or replaced, and removed from its folder
// before this returns. RESOURCE_EXHAUSTED also if the copy would leave less than a tenth of the
// free space.
absl::StatusOr<std::unique_ptr<std::istream>> CopyForReading(const std::string& path,
                                                             const std::string& by);

}  // namespace homing::storage

#endif  // STORAGE_BACKUP_H_
