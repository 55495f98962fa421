#include "client/source/image_folder.h"

#include <glob.h>

#include <array>
#include <filesystem>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/source/image_names.h"
#include "client/source/opencv_readers.h"
#include "homing/base/file_text.h"
#include "homing/base/status_macros.h"
#include "homing/image/orientation.h"

namespace homing::client {
namespace {

constexpr std::array<const char*, 9> kUnreadableEndings = {
    ".heic", ".heif", ".avif", ".gif", ".dng", ".cr2", ".nef", ".arw", ".jxl"};
// The server applies stricter limits; a file that claims more than this is no image of a camera.
constexpr DecodeLimits kFileLimits = {1, 65535, std::int64_t{1} << 28};

void AddFile(const std::filesystem::path& path, ImageList* list) {
  if (HasEnding(path.string(), kUnreadableEndings)) ++list->unreadable_kind;
  std::error_code error;
  const auto type = std::filesystem::status(path, error).type();
  // A link to nothing is listed, so that it is reported.
  const bool file =
      type == std::filesystem::file_type::regular || type == std::filesystem::file_type::not_found;
  if (!file || !HasImageEnding(path.string())) return;
  if (path.filename().string().front() == '.') {
    ++list->hidden;
  } else {
    list->paths.push_back(path.string());
  }
}

ImageList ListFolder(const std::string& folder) {
  ImageList list;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    AddFile(entry.path(), &list);
  }
  return list;
}

ImageList ListGlob(const std::string& pattern) {
  ImageList list;
  glob_t found{};
  if (::glob(pattern.c_str(), 0, nullptr, &found) == 0) {
    for (std::size_t i = 0; i < found.gl_pathc; ++i) AddFile(found.gl_pathv[i], &list);
  }
  ::globfree(&found);
  return list;
}

absl::StatusOr<std::string> ReadBytes(const std::string& path) {
  // A link to /dev/zero has no end.
  std::error_code error;
  const auto type = std::filesystem::status(path, error).type();
  if (type != std::filesystem::file_type::regular &&
      type != std::filesystem::file_type::not_found) {
    return absl::InvalidArgumentError(absl::StrCat(path, " is not a regular file"));
  }
  HOMING_ASSIGN_OR_RETURN(std::string bytes, ReadFile(path));
  if (bytes.empty()) return absl::InvalidArgumentError(absl::StrCat(path, " is empty"));
  return bytes;
}

// The encoding by the first bytes, independent of the file's name.
std::optional<FrameEncoding> EncodingOf(const std::string& bytes) {
  if (absl::StartsWith(bytes, "\xff\xd8")) return FrameEncoding::kJpeg;
  if (absl::StartsWith(bytes, "\x89PNG")) return FrameEncoding::kPng;
  return std::nullopt;
}

// OpenCV applies the orientation of TIFF, but not that of WebP.
absl::StatusOr<SourceFrame> DecodeOther(const std::string& path, const std::string& bytes) {
  HOMING_ASSIGN_OR_RETURN(const OpenCvReaders* const readers, LoadOpenCvReaders());
  HOMING_ASSIGN_OR_RETURN(SourceFrame frame, readers->read_gray_image(path));
  const int orientation = ExifOrientation(bytes);
  if (orientation == 1) return frame;
  HOMING_ASSIGN_OR_RETURN(const cv::Mat gray, DecodeGray(frame.view(), kFileLimits));
  const cv::Mat upright = TurnUpright(gray, orientation);
  frame.width = upright.cols;
  frame.height = upright.rows;
  frame.data.assign(reinterpret_cast<const char*>(upright.data), upright.total());
  return frame;
}

std::string SizeText(int width, int height) { return absl::StrCat(width, " x ", height); }

class ImageFolder : public FrameSource {
 public:
  explicit ImageFolder(ImageList images) : images_(std::move(images)) {}

  absl::StatusOr<std::optional<SourceFrame>> Next() override {
    if (next_ >= images_.paths.size()) return std::optional<SourceFrame>();
    const std::size_t index = next_++;
    const std::string& path = images_.paths[index];
    absl::StatusOr<SourceFrame> frame = ReadImage(path);
    // Without the module that reads it, every file would be skipped.
    if (absl::IsUnimplemented(frame.status())) return frame.status();
    if (!frame.ok()) return Faulty(std::string(frame.status().message()));
    const auto gray = DecodeGray(frame->view(), kFileLimits);
    if (!gray.ok()) {
      return Faulty(absl::StrCat(path, " is damaged: ", std::string(gray.status().message())));
    }
    if (width_ == 0) {
      width_ = gray->cols;
      height_ = gray->rows;
    }
    if (gray->cols != width_ || gray->rows != height_) {
      return Faulty(absl::StrCat(path, " is ", SizeText(gray->cols, gray->rows),
                                 " pixels, the first image ", SizeText(width_, height_)));
    }
    if (!images_.times_ns.empty()) frame->capture_time_ns = images_.times_ns[index];
    return std::make_optional(*std::move(frame));
  }
  std::int64_t size() const override { return static_cast<std::int64_t>(images_.paths.size()); }
  bool Seek(std::int64_t index) override {
    if (index < 0 || index > size()) return false;
    next_ = static_cast<std::size_t>(index);
    return true;
  }
  FrameKeys keys() const override {
    if (images_.times_ns.empty()) return KeysOfNames(images_.paths);
    return {FrameKeys::Kind::kTime, images_.times_ns};
  }
  std::string remark() const override {
    std::string remark;
    if (images_.hidden > 0) absl::StrAppend(&remark, images_.hidden, " hidden files left out");
    if (images_.unreadable_kind > 0) {
      absl::StrAppend(&remark, remark.empty() ? "" : ", ", images_.unreadable_kind,
                      " files of a kind that cannot be read (.heic, .gif, raw)");
    }
    return remark;
  }

 private:
  static absl::StatusOr<std::optional<SourceFrame>> Faulty(std::string fault) {
    SourceFrame frame;
    frame.fault = std::move(fault);
    return std::make_optional(std::move(frame));
  }

  ImageList images_;
  std::size_t next_ = 0;
  // Pixels of the first image that could be decoded; 0: none yet.
  int width_ = 0;
  int height_ = 0;
};

}  // namespace

absl::StatusOr<ImageList> ListImages(const std::string& folder_or_glob) {
  std::error_code error;
  const bool folder = std::filesystem::is_directory(folder_or_glob, error);
  ImageList list = folder ? ListFolder(folder_or_glob) : ListGlob(folder_or_glob);
  if (list.paths.empty()) {
    return absl::NotFoundError(
        absl::StrCat("no images in ", folder_or_glob, " (.jpg, .png, .tif, .webp, ...)",
                     list.unreadable_kind > 0 ? "; .heic, .gif and raw files cannot be read" : ""));
  }
  SortByName(&list.paths);
  return list;
}

absl::StatusOr<SourceFrame> ReadImage(const std::string& path) {
  absl::StatusOr<std::string> bytes = ReadBytes(path);
  if (!bytes.ok()) return bytes.status();
  const std::optional<FrameEncoding> encoding = EncodingOf(*bytes);
  if (!encoding) return DecodeOther(path, *bytes);
  SourceFrame frame;
  frame.encoding = *encoding;
  frame.data = *std::move(bytes);
  return frame;
}

std::unique_ptr<FrameSource> MakeImageFolder(ImageList images) {
  return std::make_unique<ImageFolder>(std::move(images));
}

}  // namespace homing::client
