#include "server/session/image_memory.h"

#include "homing/flow/working_image.h"

namespace homing::server {
namespace {

constexpr std::int64_t kUsualBytes = 8 << 20;
// An image of floats in the source's size; nine and two pyramids in the working size.
constexpr std::int64_t kBytesASourcePixel = 4;
constexpr std::int64_t kBytesAWorkingPixel = 46;

}  // namespace

std::int64_t ImageBytes(const std::array<int, 2>& widths, const std::array<int, 2>& heights,
                        const FlowOptions& options) {
  std::int64_t bytes = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    const std::int64_t pixels = std::int64_t{widths[side]} * heights[side];
    if (pixels == 0) continue;
    const cv::Size working = WorkingSize({widths[side], heights[side]}, options);
    const std::int64_t working_pixels = std::int64_t{working.width} * working.height;
    const std::int64_t of_camera =
        pixels * kBytesASourcePixel + working_pixels * kBytesAWorkingPixel;
    bytes += of_camera > kUsualBytes ? of_camera : 0;
  }
  return bytes;
}

}  // namespace homing::server
