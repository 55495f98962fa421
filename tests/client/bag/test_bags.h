// The bags of data/ and the frames in them: see make_ros1.py. Damaged copies of them.
#ifndef TESTS_CLIENT_BAG_TEST_BAGS_H_
#define TESTS_CLIENT_BAG_TEST_BAGS_H_

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/support/temporary_folder.h"

namespace homing::client::bag {

inline constexpr int kFrames = 12;
inline constexpr const char* kBags[] = {
    "none.mcap",   "zstd.mcap",     "lz4.mcap", "no_index.mcap", "no_summary_channels.mcap",
    "ros1.mcap",   "foxglove.mcap", "none.bag", "bz2.bag",       "lz4.bag",
    "rosbag2.db3", "no_chunks.mcap"};

inline std::string BagPath(const std::string& name) { return std::string(TEST_BAGS) + "/" + name; }

inline std::string TestName(std::string bag) {
  std::replace(bag.begin(), bag.end(), '.', '_');
  return bag;
}

inline std::string ReadFile(const std::string& path) {
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return bytes.str();
}

inline void WriteFile(const std::string& path, const std::string& bytes) {
  // Overwriting a file waits for the disk; making a new one does not.
  std::filesystem::remove(path);
  std::ofstream(path, std::ios::binary) << bytes;
}

inline std::string Pixels(int frame, bool right) {
  std::string pixels;
  for (int i = 0; i < 48; ++i) {
    pixels.push_back(static_cast<char>(right ? 200 - frame - i : frame + i));
  }
  return pixels;
}

}  // namespace homing::client::bag

#endif  // TESTS_CLIENT_BAG_TEST_BAGS_H_
