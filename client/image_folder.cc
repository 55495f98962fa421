#include "client/image_folder.h"

#include <glob.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/opencv_readers.h"
#include "homing/base/file_text.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

constexpr std::array<const char*, 8> kImageEndings = {".jpg", ".jpeg", ".png", ".pgm",
                                                      ".ppm", ".bmp",  ".tif", ".tiff"};

bool HasImageEnding(const std::string& path) {
  const std::string lower = absl::AsciiStrToLower(path);
  return std::any_of(kImageEndings.begin(), kImageEndings.end(),
                     [&](const char* ending) { return absl::EndsWith(lower, ending); });
}

bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

// The run of digits at `i`, without leading zeros; moves `i` behind it.
std::string TakeNumber(const std::string& text, std::size_t& i) {
  while (i < text.size() && text[i] == '0') ++i;
  const std::size_t begin = i;
  while (i < text.size() && IsDigit(text[i])) ++i;
  return text.substr(begin, i - begin);
}

std::vector<std::string> ListFolder(const std::string& folder) {
  std::vector<std::string> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.is_regular_file(error) && HasImageEnding(entry.path().string())) {
      paths.push_back(entry.path().string());
    }
  }
  return paths;
}

std::vector<std::string> ListGlob(const std::string& pattern) {
  std::vector<std::string> paths;
  glob_t found{};
  if (::glob(pattern.c_str(), 0, nullptr, &found) == 0) {
    paths.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  }
  ::globfree(&found);
  std::erase_if(paths, [](const std::string& path) { return !HasImageEnding(path); });
  return paths;
}

absl::StatusOr<std::string> ReadBytes(const std::string& path) {
  HOMING_ASSIGN_OR_RETURN(std::string bytes, ReadFile(path));
  if (bytes.empty()) return absl::InvalidArgumentError(absl::StrCat(path, " is empty"));
  return bytes;
}

// By the first bytes, independent of the file's name.
std::optional<FrameEncoding> EncodingOf(const std::string& bytes) {
  if (bytes.rfind("\xff\xd8", 0) == 0) return FrameEncoding::kJpeg;
  if (bytes.rfind("\x89PNG", 0) == 0) return FrameEncoding::kPng;
  return std::nullopt;
}

absl::StatusOr<SourceFrame> DecodeOther(const std::string& path) {
  HOMING_ASSIGN_OR_RETURN(const OpenCvReaders* const readers, LoadOpenCvReaders());
  return readers->read_gray_image(path);
}

class ImageFolder : public FrameSource {
 public:
  explicit ImageFolder(std::vector<std::string> paths) : paths_(std::move(paths)) {}

  absl::StatusOr<std::optional<SourceFrame>> Next() override {
    if (next_ >= paths_.size()) return std::optional<SourceFrame>();
    HOMING_ASSIGN_OR_RETURN(SourceFrame frame, ReadImage(paths_[next_]));
    ++next_;
    return std::make_optional(std::move(frame));
  }
  std::int64_t size() const override { return static_cast<std::int64_t>(paths_.size()); }
  bool Seek(std::int64_t index) override {
    if (index < 0 || index > size()) return false;
    next_ = static_cast<std::size_t>(index);
    return true;
  }

 private:
  std::vector<std::string> paths_;
  std::size_t next_ = 0;
};

}  // namespace

bool NaturalLess(const std::string& a, const std::string& b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (IsDigit(a[i]) && IsDigit(b[j])) {
      const std::string m = TakeNumber(a, i);
      const std::string n = TakeNumber(b, j);
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  if ((i == a.size()) != (j == b.size())) return i == a.size();
  return a < b;  // 01.png and 1.png: some fixed order
}

absl::StatusOr<std::vector<std::string>> ListImages(const std::string& folder_or_glob) {
  std::error_code error;
  const bool folder = std::filesystem::is_directory(folder_or_glob, error);
  std::vector<std::string> paths = folder ? ListFolder(folder_or_glob) : ListGlob(folder_or_glob);
  if (paths.empty()) {
    return absl::NotFoundError(absl::StrCat("no images in ", folder_or_glob, " (.jpg, .png, ...)"));
  }
  std::sort(paths.begin(), paths.end(), NaturalLess);
  return paths;
}

absl::StatusOr<SourceFrame> ReadImage(const std::string& path) {
  absl::StatusOr<std::string> bytes = ReadBytes(path);
  if (!bytes.ok()) return bytes.status();
  const std::optional<FrameEncoding> encoding = EncodingOf(*bytes);
  if (!encoding) return DecodeOther(path);
  SourceFrame frame;
  frame.encoding = *encoding;
  frame.data = *std::move(bytes);
  return frame;
}

std::unique_ptr<FrameSource> MakeImageFolder(std::vector<std::string> paths) {
  return std::make_unique<ImageFolder>(std::move(paths));
}

}  // namespace homing::client
