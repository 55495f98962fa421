// Lets one server use a store, because its memory must match the disk.
#ifndef STORAGE_STORE_LOCK_H_
#define STORAGE_STORE_LOCK_H_

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace homing::storage {

// Locks the file of the store, and "PATH-lock" beside it, while it lives. The first lock holds
// under every name of the file (hard links) and where "PATH-lock" was deleted, the second where the
// file was replaced. The system frees both when the process ends in any way. Other programs may
// read the store meanwhile: SQLite's locks are of another kind (fcntl). Closing a file frees those
// of this process too, so that this object must outlive all connections. Not thread-safe.
class StoreLock {
 public:
  // UNAVAILABLE: another process, or another store of this process, has the lock.
  // FAILED_PRECONDITION: a file cannot be opened; the store must exist.
  static absl::StatusOr<std::unique_ptr<StoreLock>> Take(const std::string& store_path);
  // A lock shared with other readers, of those files that exist; creates and changes nothing.
  // UNAVAILABLE: a writing process has the lock.
  static absl::StatusOr<std::unique_ptr<StoreLock>> TakeShared(const std::string& store_path);
  ~StoreLock();
  StoreLock(const StoreLock&) = delete;
  StoreLock& operator=(const StoreLock&) = delete;

 private:
  explicit StoreLock(std::string store_path) : store_path_(std::move(store_path)) {}
  // `flags` of open, `kind` of flock.
  absl::Status Add(const std::string& path, int flags, int kind);

  const std::string store_path_;
  // Descriptors that hold the locks.
  std::vector<int> files_;
};

}  // namespace homing::storage

#endif  // STORAGE_STORE_LOCK_H_
