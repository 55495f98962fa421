// Decoding of frames. Input: encoding, width, height, bytes.
#include "homing/image/frame.h"

#include <opencv2/core.hpp>

#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  homing::fuzz::FuzzInput input(data, size);
  homing::Frame frame;
  frame.encoding = static_cast<homing::FrameEncoding>(input.Take<std::uint8_t>() % 5);
  frame.width = input.Take<std::int16_t>();
  frame.height = input.Take<std::int16_t>();
  frame.data = input.rest();
  homing::DecodeLimits limits;
  limits.max_pixels = 1 << 20;
  const auto gray = homing::DecodeGray(frame, limits);
  if (gray.ok()) {
    homing::fuzz::Require(gray->type() == CV_8UC1 && gray->isContinuous());
    homing::fuzz::Require(std::min(gray->cols, gray->rows) >= limits.min_side_px);
    homing::fuzz::Require(std::int64_t{gray->cols} * gray->rows <= limits.max_pixels);
  }
  return 0;
}
