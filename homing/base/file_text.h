// Reads a whole file.
#ifndef HOMING_BASE_FILE_TEXT_H_
#define HOMING_BASE_FILE_TEXT_H_

#include <cerrno>
#include <fstream>
#include <sstream>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"

namespace homing {

// All bytes of the file. The error's code follows errno (NOT_FOUND, PERMISSION_DENIED and so on);
// the message names the path and the reason.
inline absl::StatusOr<std::string> ReadFile(const std::string& path) {
  errno = 0;
  const std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (file) {
    text << file.rdbuf();
  }
  // An empty file sets the fail bit only.
  if (!file || text.bad()) {
    return absl::ErrnoToStatus(errno != 0 ? errno : EIO, absl::StrCat("cannot read ", path));
  }
  return text.str();
}

}  // namespace homing

#endif  // HOMING_BASE_FILE_TEXT_H_
