#include "client/bag/bag_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "absl/strings/str_cat.h"

namespace homing::client::bag {
BagFile::BagFile(std::string path, int descriptor, std::uint64_t size)
    : path_(std::move(path)), descriptor_(descriptor), size_(size) {}

BagFile::BagFile(BagFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_) {}

BagFile& BagFile::operator=(BagFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(size_, other.size_);
  return *this;
}

BagFile::~BagFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

absl::StatusOr<BagFile> BagFile::Open(const std::string& path) {
  // O_NONBLOCK: opening a pipe without a writer must not wait.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return absl::ErrnoToStatus(errno, path);
  struct stat about {};
  if (::fstat(descriptor, &about) != 0 || !S_ISREG(about.st_mode)) {
    ::close(descriptor);
    return absl::InvalidArgumentError(absl::StrCat(path, " is not a regular file"));
  }
  return BagFile(path, descriptor, static_cast<std::uint64_t>(about.st_size));
}

absl::StatusOr<std::string> BagFile::Read(std::uint64_t offset, std::uint64_t count) const {
  if (offset > size_ || count > size_ - offset) {
    return absl::DataLossError(absl::StrCat(path_, " ends within the ", count, " bytes at ", offset,
                                            "; it has ", size_, " bytes"));
  }
  std::string bytes(static_cast<std::size_t>(count), '\0');
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = ::pread(descriptor_, bytes.data() + done, bytes.size() - done,
                                static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return absl::ErrnoToStatus(errno, path_);
    if (got == 0) return absl::DataLossError(absl::StrCat(path_, " has become shorter"));
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

absl::StatusOr<std::string> BagFile::ReadUpTo(std::uint64_t offset, std::uint64_t count) const {
  return Read(offset, offset > size_ ? 0 : std::min(count, size_ - offset));
}

}  // namespace homing::client::bag
