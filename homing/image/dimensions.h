// The bounds of an image, checked before anything is allocated.
#ifndef HOMING_IMAGE_DIMENSIONS_H_
#define HOMING_IMAGE_DIMENSIONS_H_

#include <cstdint>

#include "absl/status/status.h"
#include "homing/image/frame.h"

namespace homing {

// Pixels, as a header or a frame says; wider than int, so that no claim overflows.
struct Dimensions {
  std::int64_t width = 0;
  std::int64_t height = 0;
};

// INVALID_ARGUMENT: a side or the number of pixels outside the limits.
absl::Status CheckLimits(const Dimensions& dimensions, const DecodeLimits& limits);

// INVALID_ARGUMENT: the frame gives a width or height, and the image's header another.
absl::Status CheckDeclared(const Frame& frame, const Dimensions& header);

}  // namespace homing

#endif  // HOMING_IMAGE_DIMENSIONS_H_
