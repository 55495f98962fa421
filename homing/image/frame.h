// One image as it came over the wire or from a file, and its bounded decoding to grey.
// Source: own design; the paper needs grey values only (II-B).
#ifndef HOMING_IMAGE_FRAME_H_
#define HOMING_IMAGE_FRAME_H_

#include <cstdint>
#include <opencv2/core.hpp>
#include <string_view>

#include "absl/status/statusor.h"

namespace homing {

enum class FrameEncoding { kGray8, kRgb8, kBgr8, kJpeg, kPng };

// Does not own its bytes.
struct Frame {
  FrameEncoding encoding = FrameEncoding::kGray8;
  // Pixels. Required for raw encodings; for JPEG and PNG 0, or what the image's header says.
  int width = 0;
  int height = 0;
  std::string_view data;
};

// Checked against the header before anything is allocated.
struct DecodeLimits {
  int min_side_px = 16;
  int max_side_px = 8192;
  std::int64_t max_pixels = 16 * 1024 * 1024;
};

// Grey image, CV_8UC1, height x width; it owns its pixels. Colour is reduced by
// 0.299 R + 0.587 G + 0.114 B. Grey of 16 bits is stretched to the range that it uses. JPEG and PNG
// are turned as their EXIF orientation says, so width and height may change places.
// INVALID_ARGUMENT: dimensions outside the limits or unlike the header, wrong buffer length, bytes
// that are no image or end too early. Thread-safe.
absl::StatusOr<cv::Mat> DecodeGray(const Frame& frame, const DecodeLimits& limits = {});

}  // namespace homing

#endif  // HOMING_IMAGE_FRAME_H_
