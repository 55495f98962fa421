#include "client/command/output_file.h"

#include <filesystem>
#include <fstream>

#include "absl/strings/str_cat.h"

namespace homing::client {

absl::StatusOr<std::uintmax_t> WriteOutputFile(
    const std::string& path, const std::function<absl::Status(std::ostream&)>& write) {
  const std::string part = path + ".part";
  std::ofstream file(part, std::ios::binary | std::ios::trunc);
  if (!file) return absl::PermissionDeniedError(absl::StrCat("cannot write ", part));
  absl::Status status = write(file);
  file.close();
  if (status.ok() && !file) status = absl::ResourceExhaustedError("cannot write " + part);
  std::error_code error;
  if (status.ok()) std::filesystem::rename(part, path, error);
  if (!status.ok() || error) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    return status.ok() ? absl::PermissionDeniedError("cannot write " + path) : status;
  }
  return std::filesystem::file_size(path, error);
}

}  // namespace homing::client
