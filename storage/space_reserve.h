// Space on the disk that is kept for deleting: a full disk has no room for the log of a deletion.
#ifndef STORAGE_SPACE_RESERVE_H_
#define STORAGE_SPACE_RESERVE_H_

#include <cstdint>
#include <string>

namespace homing::storage {

// A file without content beside the store. Not thread-safe.
class SpaceReserve {
 public:
  // As much as the log may hold before it is moved into the file, which may then grow by that.
  static constexpr std::int64_t kMostBytes = 64 << 20;

  // Gives up what a server before this one kept, so that the store can be opened on a full disk.
  explicit SpaceReserve(const std::string& store_path);
  ~SpaceReserve() { GiveUp(); }
  SpaceReserve(const SpaceReserve&) = delete;
  SpaceReserve& operator=(const SpaceReserve&) = delete;

  // Keeps kMostBytes, but no more than a quarter of what is free.
  void Fill();
  // Keeps up to `bytes` again, whatever is left then.
  void TakeBack(std::int64_t bytes);
  std::int64_t bytes() const { return bytes_; }
  // Returns how many bytes the disk has more now.
  std::int64_t GiveUp();

 private:
  const std::string path_;
  std::int64_t bytes_ = 0;
  // The file system can keep space for a file.
  bool can_reserve_ = true;
};

}  // namespace homing::storage

#endif  // STORAGE_SPACE_RESERVE_H_
