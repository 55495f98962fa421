#include "storage/store_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "absl/strings/str_cat.h"

namespace homing::storage {
namespace {

std::string LockPath(const std::string& store_path) {
  // A link to the store locks the same store.
  std::error_code error;
  const std::filesystem::path real = std::filesystem::weakly_canonical(store_path, error);
  return absl::StrCat(error ? store_path : real.string(), "-lock");
}

absl::Status InUse(const std::string& store_path) {
  return absl::UnavailableError(
      absl::StrCat("store: '", store_path, "' is in use by another homing-server"));
}

}  // namespace

absl::StatusOr<std::unique_ptr<StoreLock>> StoreLock::Take(const std::string& store_path) {
  const std::string path = LockPath(store_path);
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (file < 0) {
    return absl::FailedPreconditionError(
        absl::StrCat("store: cannot open '", path, "': ", std::strerror(errno)));
  }
  if (::flock(file, LOCK_EX | LOCK_NB) != 0) {
    ::close(file);
    return InUse(store_path);
  }
  return std::unique_ptr<StoreLock>(new StoreLock(file));
}

absl::StatusOr<std::unique_ptr<StoreLock>> StoreLock::TakeShared(const std::string& store_path) {
  const int file = ::open(LockPath(store_path).c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return std::unique_ptr<StoreLock>();
  if (::flock(file, LOCK_SH | LOCK_NB) != 0) {
    ::close(file);
    return InUse(store_path);
  }
  return std::unique_ptr<StoreLock>(new StoreLock(file));
}

StoreLock::~StoreLock() { ::close(file_); }

}  // namespace homing::storage
