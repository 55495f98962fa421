#include "client/command/growing_file.h"

#include <cerrno>
#include <filesystem>

#include "absl/strings/str_cat.h"
#include "client/file/output_file.h"

namespace homing::client {

absl::StatusOr<std::ofstream> OpenGrowingFile(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    return absl::InvalidArgumentError(absl::StrCat(path, " is not a regular file"));
  }
  errno = 0;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  if (!file) return CannotWrite(path, errno);
  return file;
}

}  // namespace homing::client
