// Space on the disk that is kept for deleting: a full disk has no room for the log of a deletion.
#ifndef STORAGE_SPACE_RESERVE_H_
#define STORAGE_SPACE_RESERVE_H_

#include <cstdint>
#include <string>

namespace homing::storage {

// A file beside the store that has space but no content. Not thread-safe.
class SpaceReserve {
 public:
  // The most that the log holds before it is moved into the file, which may then grow by as much.
  static constexpr std::int64_t kMostBytes = 64 << 20;

  // Frees the reserve of an earlier server, so that the store can be opened on a full disk.
  explicit SpaceReserve(const std::string& store_path);
  ~SpaceReserve() { GiveUp(); }
  SpaceReserve(const SpaceReserve&) = delete;
  SpaceReserve& operator=(const SpaceReserve&) = delete;

  // Reserves kMostBytes, but at most a quarter of the free space.
  void Fill();
  // Reserves up to `bytes` again, however little space is left then.
  void TakeBack(std::int64_t bytes);
  std::int64_t bytes() const { return bytes_; }
  // Frees the reserve. Returns the number of freed bytes.
  std::int64_t GiveUp();

 private:
  const std::string path_;
  std::int64_t bytes_ = 0;
  // The file system can keep space for a file.
  bool can_reserve_ = true;
};

}  // namespace homing::storage

#endif  // STORAGE_SPACE_RESERVE_H_
