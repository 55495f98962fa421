// One server a store: what is in memory must be what is on the disk.
#ifndef STORAGE_STORE_LOCK_H_
#define STORAGE_STORE_LOCK_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"

namespace homing::storage {

// Holds the file beside the store, "PATH-lock", for as long as it lives; the system lets go of it
// when the process ends, however it ends. Other programs may read the store all the while.
class StoreLock {
 public:
  // UNAVAILABLE: another process (or another store of this one) has it. FAILED_PRECONDITION: the
  // file cannot be opened.
  static absl::StatusOr<std::unique_ptr<StoreLock>> Take(const std::string& store_path);
  // Shared with other readers; nothing is made or changed. Null: there is no such file, so that no
  // server has used the store where it lies now. UNAVAILABLE: a process that writes has it.
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
