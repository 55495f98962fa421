// Checks the size of an image before anything is allocated.
#ifndef HOMING_IMAGE_DIMENSIONS_H_
#define HOMING_IMAGE_DIMENSIONS_H_

#include <cstdint>

#include "absl/status/status.h"
#include "homing/image/frame.h"

namespace homing {

// Pixels, as in a header or a frame; 64 bits, so that no value overflows.
struct Dimensions {
  std::int64_t width = 0;
  std::int64_t height = 0;
};

// INVALID_ARGUMENT: a side or the number of pixels outside the limits.
absl::Status CheckLimits(const Dimensions& dimensions, const DecodeLimits& limits);

// INVALID_ARGUMENT: the frame's width or height differs from the image header's.
absl::Status CheckDeclared(const Frame& frame, const Dimensions& header);

}  // namespace homing

#endif  // HOMING_IMAGE_DIMENSIONS_H_
