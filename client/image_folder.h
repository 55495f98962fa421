// Frames from the image files of a folder or glob.
#ifndef CLIENT_IMAGE_FOLDER_H_
#define CLIENT_IMAGE_FOLDER_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/frame_source.h"

namespace homing::client {

// Numbers inside names count as numbers: 2.png before 10.png.
bool NaturalLess(const std::string& a, const std::string& b);

// The image files of a folder or of a glob, in natural order. NOT_FOUND: none.
absl::StatusOr<std::vector<std::string>> ListImages(const std::string& folder_or_glob);

// One image file. JPEG and PNG unchanged, other formats as GRAY8. NOT_FOUND, INVALID_ARGUMENT.
absl::StatusOr<SourceFrame> ReadImage(const std::string& path);

// The given files in the given order.
std::unique_ptr<FrameSource> MakeImageFolder(std::vector<std::string> paths);

}  // namespace homing::client

#endif  // CLIENT_IMAGE_FOLDER_H_
