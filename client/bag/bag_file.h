// A file that is read in pieces at any place.
#ifndef CLIENT_BAG_BAG_FILE_H_
#define CLIENT_BAG_BAG_FILE_H_

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"

namespace homing::client::bag {

// Moveable. Not thread-safe.
class BagFile {
 public:
  // NOT_FOUND, PERMISSION_DENIED; INVALID_ARGUMENT: not a regular file.
  static absl::StatusOr<BagFile> Open(const std::string& path);
  BagFile(BagFile&& other) noexcept;
  BagFile& operator=(BagFile&& other) noexcept;
  ~BagFile();

  const std::string& path() const { return path_; }
  // Bytes, as of the opening.
  std::uint64_t size() const { return size_; }
  // Exactly `count` bytes. DATA_LOSS: they end beyond the file; nothing is allocated then.
  absl::StatusOr<std::string> Read(std::uint64_t offset, std::uint64_t count) const;
  // At most `count` bytes, less at the end of the file.
  absl::StatusOr<std::string> ReadUpTo(std::uint64_t offset, std::uint64_t count) const;

 private:
  BagFile(std::string path, int descriptor, std::uint64_t size);

  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace homing::client::bag

#endif  // CLIENT_BAG_BAG_FILE_H_
