// Reads a whole file.
#ifndef HOMING_BASE_FILE_TEXT_H_
#define HOMING_BASE_FILE_TEXT_H_

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <fstream>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"

namespace homing {

// No file that Homing reads whole is larger; a link to /dev/zero has no end.
inline constexpr std::size_t kMostFileBytes = std::size_t{1} << 28;

// All bytes of the file. The error's code follows errno (NOT_FOUND, PERMISSION_DENIED and so on);
// the message names the path and the reason. INVALID_ARGUMENT: more than kMostFileBytes.
inline absl::StatusOr<std::string> ReadFile(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string bytes;
  std::size_t read = 0;
  while (file && read <= kMostFileBytes) {
    bytes.resize(std::max<std::size_t>(std::size_t{1} << 16, 2 * read));
    file.read(bytes.data() + read, static_cast<std::streamsize>(bytes.size() - read));
    read += static_cast<std::size_t>(file.gcount());
  }
  if (read > kMostFileBytes) {
    return absl::InvalidArgumentError(
        absl::StrCat("cannot read ", path, ": it has more than ", kMostFileBytes, " bytes"));
  }
  // The end of a file sets the end bit too.
  if (!file.eof()) {
    return absl::ErrnoToStatus(errno != 0 ? errno : EIO, absl::StrCat("cannot read ", path));
  }
  bytes.resize(read);
  return bytes;
}

}  // namespace homing

#endif  // HOMING_BASE_FILE_TEXT_H_
