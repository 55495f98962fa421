// A camera that can be stopped at any time.
#ifndef CLIENT_SOURCE_LIVE_SOURCE_H_
#define CLIENT_SOURCE_LIVE_SOURCE_H_

#include <memory>
#include <stop_token>

#include "client/source/frame_source.h"

namespace homing::client {

// The frames of `camera`, read on a separate thread: at a stop the source ends at once, even while
// the camera gives nothing. REQUIRES: camera->live().
std::unique_ptr<FrameSource> MakeStoppable(std::unique_ptr<FrameSource> camera,
                                           std::stop_token stop);

}  // namespace homing::client

#endif  // CLIENT_SOURCE_LIVE_SOURCE_H_
