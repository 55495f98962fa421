// Frames from a video file or a camera of this machine. Source: own design.
#ifndef CLIENT_VIDEO_SOURCE_H_
#define CLIENT_VIDEO_SOURCE_H_

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/frame_source.h"

namespace homing::client {

// /dev/videoN is live: no size, no seeking. NOT_FOUND: no such file; INVALID_ARGUMENT: not a video,
// or without frames; UNIMPLEMENTED: this build reads no videos.
absl::StatusOr<std::unique_ptr<FrameSource>> OpenVideo(const std::string& path);

}  // namespace homing::client

#endif  // CLIENT_VIDEO_SOURCE_H_
