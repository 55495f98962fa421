#include "storage/store_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"

namespace homing::storage {
namespace {

std::string LockPath(const std::string& store_path) {
  // A link to the store locks the same store.
  std::error_code error;
  const std::filesystem::path real = std::filesystem::weakly_canonical(store_path, error);
  return absl::StrCat(error ? store_path : real.string(), "-lock");
}

}  // namespace

absl::Status StoreLock::Add(const std::string& path, int flags, int kind) {
  const int file = ::open(path.c_str(), flags | O_CLOEXEC, 0644);
  if (file < 0) {
    return absl::FailedPreconditionError(
        absl::StrCat("store: cannot open '", path, "': ", std::strerror(errno)));
  }
  files_.push_back(file);
  if (::flock(file, kind | LOCK_NB) == 0) return absl::OkStatus();
  return absl::UnavailableError(
      absl::StrCat("store: '", store_path_, "' is in use by another homing-server"));
}

absl::StatusOr<std::unique_ptr<StoreLock>> StoreLock::Take(const std::string& store_path) {
  std::unique_ptr<StoreLock> lock(new StoreLock(store_path));
  HOMING_RETURN_IF_ERROR(lock->Add(LockPath(store_path), O_RDWR | O_CREAT, LOCK_EX));
  HOMING_RETURN_IF_ERROR(lock->Add(store_path, O_RDONLY, LOCK_EX));
  return lock;
}

absl::StatusOr<std::unique_ptr<StoreLock>> StoreLock::TakeShared(const std::string& store_path) {
  std::unique_ptr<StoreLock> lock(new StoreLock(store_path));
  for (const std::string& path : {LockPath(store_path), store_path}) {
    absl::Status status = lock->Add(path, O_RDONLY, LOCK_SH);
    if (absl::IsUnavailable(status)) return status;
  }
  return lock;
}

StoreLock::~StoreLock() {
  for (const int file : files_) ::close(file);
}

}  // namespace homing::storage
