#include "server/access/private_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "absl/strings/str_cat.h"

namespace homing::server {
namespace {

absl::Status WriteTo(const std::string& path, const std::string& text, int flags) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | flags, S_IRUSR | S_IWUSR);
  std::size_t written = 0;
  while (file >= 0 && written < text.size()) {
    const ssize_t count = ::write(file, text.data() + written, text.size() - written);
    if (count < 0 && errno != EINTR) {
      break;
    }
    written += count > 0 ? static_cast<std::size_t>(count) : 0;
  }
  const bool whole = file >= 0 && written == text.size();
  const int error = errno;
  if (file < 0 || (::close(file) != 0 && whole) || !whole) {
    return absl::InvalidArgumentError(
        absl::StrCat("\"", path, "\" cannot be written: ", std::strerror(error)));
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status WritePrivateFile(const std::string& path, const std::string& text) {
  std::error_code error;
  // A link stays a link: its target is replaced.
  std::filesystem::path target = path;
  if (std::filesystem::is_symlink(target, error)) {
    target = std::filesystem::weakly_canonical(target, error);
  }
  const auto before = std::filesystem::status(target, error);
  if (std::filesystem::exists(before) && !std::filesystem::is_regular_file(before)) {
    return WriteTo(path, text, 0);
  }
  // A file that others may read is replaced by a new one.
  const std::string fresh = target.string() + ".new";
  ::unlink(fresh.c_str());
  absl::Status status = WriteTo(fresh, text, O_EXCL);
  if (status.ok() && ::rename(fresh.c_str(), target.c_str()) != 0) {
    status = absl::InvalidArgumentError(
        absl::StrCat("\"", path, "\" cannot be written: ", std::strerror(errno)));
  }
  return status;
}

absl::Status AppendPrivateFile(const std::string& path, const std::string& text) {
  return WriteTo(path, text, O_APPEND);
}

}  // namespace homing::server
