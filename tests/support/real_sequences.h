// Real image sequences for tests, which are not part of the project: found at HOMING_DATA, else at
// ../shared/data from the project's root.
#ifndef TESTS_SUPPORT_REAL_SEQUENCES_H_
#define TESTS_SUPPORT_REAL_SEQUENCES_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "homing/image/frame.h"

namespace homing {

// Folder of a sequence, empty if it is not there.
inline std::filesystem::path RealSequence(const std::string& name) {
  const char* set = std::getenv("HOMING_DATA");
  const std::filesystem::path root =
      set != nullptr ? std::filesystem::path(set)
                     : std::filesystem::path(HOMING_SOURCE_DIR) / ".." / "shared" / "data";
  const std::filesystem::path folder = root / name;
  return std::filesystem::is_directory(folder) ? folder : std::filesystem::path();
}

inline std::string BytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// The image of a .jpg or .png file.
inline cv::Mat ReadImage(const std::filesystem::path& file) {
  const std::string bytes = BytesOf(file);
  const bool png = file.extension() == ".png";
  return DecodeGray({png ? FrameEncoding::kPng : FrameEncoding::kJpeg, 0, 0, bytes}).value();
}

// Up to `count` images of a folder in natural order.
inline std::vector<cv::Mat> ReadImages(const std::filesystem::path& folder, std::size_t count) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".jpg" || entry.path().extension() == ".png") {
      files.push_back(entry.path());
    }
  }
  // Shorter names first: 9 before 10.
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
    const std::string x = a.filename().string();
    const std::string y = b.filename().string();
    return x.size() != y.size() ? x.size() < y.size() : x < y;
  });
  std::vector<cv::Mat> images;
  for (std::size_t i = 0; i < std::min(count, files.size()); ++i) {
    images.push_back(ReadImage(files[i]));
  }
  return images;
}

}  // namespace homing

// Ends the test as skipped where the sequence is absent.
#define HOMING_SKIP_WITHOUT(name)                                          \
  if (::homing::RealSequence(name).empty()) {                              \
    GTEST_SKIP() << "SKIPPED: real sequence " << (name) << " is not here"; \
  }                                                                        \
  static_assert(true, "a semicolon follows")

#endif  // TESTS_SUPPORT_REAL_SEQUENCES_H_
