// A copy of a database as of one moment, taken while a server uses it. Source: SQLite's backup API.
#ifndef STORAGE_BACKUP_H_
#define STORAGE_BACKUP_H_

#include <istream>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace homing::storage {

// Makes the file `to`: whole, checked and on the disk, or not there at all. Writers go on
// meanwhile. ALREADY_EXISTS; FAILED_PRECONDITION: no such file, another program's, or of a newer
// version; DATA_LOSS: what was read is damaged; RESOURCE_EXHAUSTED: disk full.
absl::Status BackUp(const std::string& path, const std::string& to);

// The same for one who reads it once: the file `by` is made, replaced if it is there, and has no
// name any more when this returns. RESOURCE_EXHAUSTED also if the copy would leave less than a
// tenth of the room that is free.
absl::StatusOr<std::unique_ptr<std::istream>> CopyForReading(const std::string& path,
                                                             const std::string& by);

}  // namespace homing::storage

#endif  // STORAGE_BACKUP_H_
