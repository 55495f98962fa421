// Lets one server use a store, because its memory must match the disk.
#ifndef STORAGE_STORE_LOCK_H_
#define STORAGE_STORE_LOCK_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"

namespace homing::storage {

// Locks the file "PATH-lock" beside the store while it lives. The system frees the lock when the
// process ends in any way. Other programs may read the store meanwhile. Not thread-safe.
class StoreLock {
 public:
  // UNAVAILABLE: another process, or another store of this process, has the lock.
  // FAILED_PRECONDITION: the file cannot be opened.
  static absl::StatusOr<std::unique_ptr<StoreLock>> Take(const std::string& store_path);
  // A lock shared with other readers; creates and changes nothing. Null: there is no lock file, so
  // no server has used the store in this place. UNAVAILABLE: a writing process has the lock.
  static absl::StatusOr<std::unique_ptr<StoreLock>> TakeShared(const std::string& store_path);
  ~StoreLock();
  StoreLock(const StoreLock&) = delete;
  StoreLock& operator=(const StoreLock&) = delete;

 private:
  explicit StoreLock(int file) : file_(file) {}

  const int file_;
};

}  // namespace homing::storage

#endif  // STORAGE_STORE_LOCK_H_
