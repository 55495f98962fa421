// Reads a whole file.
#ifndef HOMING_BASE_FILE_TEXT_H_
#define HOMING_BASE_FILE_TEXT_H_

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"

namespace homing {

// All bytes of the file. NOT_FOUND: it cannot be read; the message names the path and the reason.
inline absl::StatusOr<std::string> ReadFile(const std::string& path) {
  errno = 0;
  const std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (file) {
    text << file.rdbuf();
  }
  // An empty file sets the fail bit only.
  if (!file || text.bad()) {
    return absl::NotFoundError(absl::StrCat(
        "cannot read ", path, errno != 0 ? absl::StrCat(": ", std::strerror(errno)) : ""));
  }
  return text.str();
}

}  // namespace homing

#endif  // HOMING_BASE_FILE_TEXT_H_
