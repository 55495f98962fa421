// OpenCV's readers of images and videos, as a module that is loaded on first use: they bring 200
// libraries, which take longer to load than most commands to run.
#ifndef CLIENT_SOURCE_OPENCV_READERS_H_
#define CLIENT_SOURCE_OPENCV_READERS_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/source/frame_source.h"

namespace homing::client {

struct OpenCvReaders {
  // Any format that OpenCV can read, as GRAY8. INVALID_ARGUMENT: no image.
  absl::StatusOr<SourceFrame> (*read_gray_image)(const std::string& path) = nullptr;
  // See client/opencv/video_source.h.
  absl::StatusOr<std::unique_ptr<FrameSource>> (*open_video)(const std::string& path) = nullptr;
};

// UNIMPLEMENTED: homing_opencv.so is neither beside the program, nor in ../lib/homing, nor on the
// system's library path. Thread-safe.
absl::StatusOr<const OpenCvReaders*> LoadOpenCvReaders();

}  // namespace homing::client

#endif  // CLIENT_SOURCE_OPENCV_READERS_H_
