#include "server/access/flag_file.h"

#include <fstream>
#include <sstream>

#include "absl/strings/str_cat.h"

namespace homing::server {

absl::Status FlagFileError(const std::string& flag, const std::string& path,
                           const std::string& what) {
  return absl::InvalidArgumentError(absl::StrCat(flag, " is \"", path, "\"; ", what));
}

absl::StatusOr<std::string> ReadFlagFile(const std::string& flag, const std::string& path) {
  const std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) {
    return FlagFileError(flag, path, "the file cannot be read");
  }
  return text.str();
}

}  // namespace homing::server
