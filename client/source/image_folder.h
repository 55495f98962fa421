// Frames from the image files of a folder or glob.
#ifndef CLIENT_SOURCE_IMAGE_FOLDER_H_
#define CLIENT_SOURCE_IMAGE_FOLDER_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/source/frame_source.h"

namespace homing::client {

struct ImageList {
  std::vector<std::string> paths;
  // Capture time of each file, ascending, nanoseconds; empty: the names decide.
  std::vector<std::int64_t> times_ns = {};
  // Hidden files with an image's name, left out.
  int hidden = 0;
  // Image files of a kind that cannot be read, left out: .heic and the like.
  int unreadable_kind = 0;
};

// The image files of a folder or of a glob, in the order of SortByName. NOT_FOUND: none.
absl::StatusOr<ImageList> ListImages(const std::string& folder_or_glob);

// Reads one image file: JPEG and PNG unchanged, other formats as GRAY8. The system's error, or
// INVALID_ARGUMENT: the file is empty, or its first bytes are those of no image.
absl::StatusOr<SourceFrame> ReadImage(const std::string& path);

// The given files in the given order. Files that cannot be decoded, and those of another size than
// the first, are frames with a fault.
std::unique_ptr<FrameSource> MakeImageFolder(ImageList images);

}  // namespace homing::client

#endif  // CLIENT_SOURCE_IMAGE_FOLDER_H_
