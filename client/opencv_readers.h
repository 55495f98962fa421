// OpenCV's readers of images and videos. They bring 200 libraries, which take longer to load than
// most commands to run: a module of its own, loaded when it is first needed.
#ifndef CLIENT_OPENCV_READERS_H_
#define CLIENT_OPENCV_READERS_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/frame_source.h"

namespace homing::client {

struct OpenCvReaders {
  // Any format that OpenCV knows, as GRAY8. INVALID_ARGUMENT: no image.
  absl::StatusOr<SourceFrame> (*read_gray_image)(const std::string& path) = nullptr;
  // See client/opencv/video_source.h.
  absl::StatusOr<std::unique_ptr<FrameSource>> (*open_video)(const std::string& path) = nullptr;
};

// UNIMPLEMENTED: homing_opencv.so is not beside the program, not in ../lib/homing and not where the
// system looks for libraries. Thread-safe.
absl::StatusOr<const OpenCvReaders*> LoadOpenCvReaders();

}  // namespace homing::client

#endif  // CLIENT_OPENCV_READERS_H_
