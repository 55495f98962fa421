// Checks that the files that SQLite has open are still those of the path.
#ifndef STORAGE_FILE_IDENTITY_H_
#define STORAGE_FILE_IDENTITY_H_

#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "homing/base/mutex.h"

namespace homing::storage {

// The database and its log ("-wal"). SQLite keeps writing into a file that was removed or
// replaced, without an error. Thread-safe.
class FileIdentity {
 public:
  // Remembers the current files as the expected ones; the log as soon as it exists.
  explicit FileIdentity(std::string path);

  // `bytes`: least size of the log, which holds pages that are not yet in the database.
  void SetLogBytes(std::int64_t bytes) { log_bytes_ = bytes; }
  // True if the log is shorter than the size given to SetLogBytes.
  bool IsLogCut();
  // UNAVAILABLE, a fault of the store: a file was removed, replaced or cut.
  absl::Status Check();

 private:
  struct File {
    dev_t device = 0;
    ino_t inode = 0;
    std::int64_t size = 0;
  };
  static std::optional<File> Look(const std::string& path);

  const std::string path_;
  Mutex mutex_;
  std::optional<File> database_ HOMING_GUARDED_BY(mutex_);
  std::optional<File> log_ HOMING_GUARDED_BY(mutex_);
  std::atomic<std::int64_t> log_bytes_ = 0;
};

}  // namespace homing::storage

#endif  // STORAGE_FILE_IDENTITY_H_
