#include "server/access/flag_file.h"

#include <filesystem>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/file_text.h"

namespace homing::server {

absl::Status FlagFileError(const std::string& flag, const std::string& path,
                           const std::string& what) {
  return FieldError(flag, absl::StrCat("\"", path, "\" ", what));
}

absl::StatusOr<std::string> ReadFlagFile(const std::string& flag, const std::string& path) {
  std::error_code error;
  const auto kind = std::filesystem::status(path, error);
  // A pipe would hold up the thread that reads the files again, a device never ends.
  if (std::filesystem::exists(kind) && !std::filesystem::is_regular_file(kind)) {
    return FlagFileError(flag, path, "is not a regular file");
  }
  absl::StatusOr<std::string> text = ReadFile(path);
  return text.ok() ? std::move(text) : FlagFileError(flag, path, "cannot be read");
}

}  // namespace homing::server
