#include "storage/file_identity.h"

#include <sys/stat.h>

#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "storage/sqlite_status.h"

namespace homing::storage {
namespace {

absl::Status Lost(const std::string& path, const std::string& what) {
  return StoreFault(absl::StatusCode::kUnavailable,
                    absl::StrCat("store: '", path, "' ", what,
                                 " while the server runs; nothing more is recorded. Put the file "
                                 "back and start the server again"));
}

}  // namespace

FileIdentity::FileIdentity(std::string path) : path_(std::move(path)), database_(Look(path_)) {}

std::optional<FileIdentity::File> FileIdentity::Look(const std::string& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0) return std::nullopt;
  return File{found.st_dev, found.st_ino, found.st_size};
}

bool FileIdentity::IsLogCut() {
  const auto log = Look(path_ + "-wal");
  return log && log->size < log_bytes_;
}

absl::Status FileIdentity::Check() {
  const std::string log_path = path_ + "-wal";
  const MutexLock lock(mutex_);
  const auto check = [](const std::string& path, File* known, std::int64_t least) {
    const auto now = Look(path);
    if (!now) return Lost(path, "was removed");
    if (now->inode != known->inode || now->device != known->device) {
      return Lost(path, "was replaced by another file");
    }
    if (now->size < least) return Lost(path, "was cut");
    known->size = now->size;
    return absl::OkStatus();
  };
  // The database never shrinks.
  if (database_) HOMING_RETURN_IF_ERROR(check(path_, &*database_, database_->size));
  if (!log_) log_ = Look(log_path);
  return log_ ? check(log_path, &*log_, log_bytes_) : absl::OkStatus();
}

}  // namespace homing::storage
