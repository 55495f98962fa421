#include "storage/space_reserve.h"

#include <fcntl.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace homing::storage {
namespace {

// A smaller reserve cannot hold the log of a deletion.
constexpr std::int64_t kLeastBytes = 256 << 10;
// A smaller gain is not worth another attempt.
constexpr std::int64_t kGrowth = 1 << 20;

std::int64_t FreeBytes(const std::string& path) {
  struct statvfs disk {};
  if (::statvfs(path.c_str(), &disk) != 0) return 0;
  return static_cast<std::int64_t>(disk.f_bavail) * static_cast<std::int64_t>(disk.f_frsize);
}

}  // namespace

SpaceReserve::SpaceReserve(const std::string& store_path) : path_(store_path + "-reserve") {
  ::unlink(path_.c_str());
}

void SpaceReserve::Fill() {
  const std::size_t slash = path_.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : path_.substr(0, slash + 1);
  const std::int64_t wanted = std::min(kMostBytes, (FreeBytes(folder) + bytes_) / 4);
  if (bytes_ == 0 || wanted >= std::min(kMostBytes, bytes_ + kGrowth)) TakeBack(wanted);
}

void SpaceReserve::TakeBack(std::int64_t bytes) {
  if (bytes < kLeastBytes || !can_reserve_) return;
  // An existing file of this name does not belong to this server.
  const int flags = O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW | (bytes_ == 0 ? O_EXCL : 0);
  const int file = ::open(path_.c_str(), flags, 0600);
  if (file < 0) return;
  while (bytes > bytes_ && bytes >= kLeastBytes) {
    // A file system without fallocate has no reserve: writing as many bytes would take too long.
    if (::fallocate(file, 0, 0, bytes) == 0) {
      bytes_ = bytes;
    } else {
      can_reserve_ = errno == ENOSPC || errno == EDQUOT || errno == EINTR;
      bytes = can_reserve_ ? bytes / 2 : 0;
    }
  }
  ::close(file);
  if (bytes_ == 0) ::unlink(path_.c_str());
}

std::int64_t SpaceReserve::GiveUp() {
  if (bytes_ == 0 || ::unlink(path_.c_str()) != 0) return 0;
  return std::exchange(bytes_, 0);
}

}  // namespace homing::storage
