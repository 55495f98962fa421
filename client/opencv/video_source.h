// Frames from a video file or a camera of this machine.
#ifndef CLIENT_OPENCV_VIDEO_SOURCE_H_
#define CLIENT_OPENCV_VIDEO_SOURCE_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/source/frame_source.h"

namespace homing::client {

// Grey frames. Cameras and pipes are live: no size, no seeking. A damaged part is a gap; DATA_LOSS
// at an end that comes before the number of frames in the file's header. INVALID_ARGUMENT: not a
// video (texts and single images are none), or without frames.
absl::StatusOr<std::unique_ptr<FrameSource>> OpenVideo(const std::string& path);

}  // namespace homing::client

#endif  // CLIENT_OPENCV_VIDEO_SOURCE_H_
