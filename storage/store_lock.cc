#include "storage/store_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "absl/strings/str_cat.h"

namespace homing::storage {

absl::StatusOr<std::unique_ptr<StoreLock>> StoreLock::Take(const std::string& store_path) {
  // A link to the store is the same store.
  std::error_code error;
  const std::filesystem::path real = std::filesystem::weakly_canonical(store_path, error);
  const std::string path = absl::StrCat(error ? store_path : real.string(), "-lock");
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (file < 0) {
    return absl::FailedPreconditionError(
        absl::StrCat("store: cannot open '", path, "': ", std::strerror(errno)));
  }
  if (::flock(file, LOCK_EX | LOCK_NB) != 0) {
    ::close(file);
    return absl::UnavailableError(
        absl::StrCat("store: '", store_path, "' is in use by another homing-server"));
  }
  return std::unique_ptr<StoreLock>(new StoreLock(file));
}

StoreLock::~StoreLock() { ::close(file_); }

}  // namespace homing::storage
