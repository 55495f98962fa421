// The number of pixels of an image, without a decoder.
#ifndef HOMING_IMAGE_HEADER_PIXELS_H_
#define HOMING_IMAGE_HEADER_PIXELS_H_

#include <cstdint>
#include <optional>

#include "homing/image/frame.h"

namespace homing {

// As the header says, which may be wrong; the time does not depend on the image. Nothing: there is
// no header that this function understands.
std::optional<std::int64_t> HeaderPixels(const Frame& frame);

}  // namespace homing

#endif  // HOMING_IMAGE_HEADER_PIXELS_H_
