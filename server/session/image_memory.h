// The memory in which a stream's frames are tracked, which it keeps until it ends.
#ifndef SERVER_SESSION_IMAGE_MEMORY_H_
#define SERVER_SESSION_IMAGE_MEMORY_H_

#include <array>
#include <cstdint>

#include "homing/flow/flow_tracker.h"

namespace homing::server {

// Bytes for frames of these sizes, by camera; 0 x 0: none. Up to 8 MiB of a camera count as 0,
// since max_streams bounds them: usual images, of about a megapixel.
std::int64_t ImageBytes(const std::array<int, 2>& widths, const std::array<int, 2>& heights,
                        const FlowOptions& options);

}  // namespace homing::server

#endif  // SERVER_SESSION_IMAGE_MEMORY_H_
