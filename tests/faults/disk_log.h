// The record of a program's requests to its disk, written by faulty_disk.cc and read by
// power_cut.cc: a header, the file's name, then `size` bytes if it is a write.
#ifndef TESTS_FAULTS_DISK_LOG_H_
#define TESTS_FAULTS_DISK_LOG_H_

#include <cstdint>

namespace homing::faults {

enum class DiskOp : std::uint32_t {
  kCreate = 1,    // the name came into the folder
  kWrite = 2,     // `size` bytes at `offset`
  kTruncate = 3,  // to `offset` bytes
  kSync = 4,      // the file's bytes are on the disk
  kUnlink = 5,    // the name left the folder
  kSyncNames = 6  // the folder itself is on the disk
};

struct DiskRecord {
  DiskOp op = DiskOp::kWrite;
  std::uint32_t name_size = 0;
  std::int64_t offset = 0;
  std::int64_t size = 0;
};

}  // namespace homing::faults

#endif  // TESTS_FAULTS_DISK_LOG_H_
