// One image from the wire or a file, and its bounded decoding to grey. The paper needs grey values
// only (II-B).
#ifndef HOMING_IMAGE_FRAME_H_
#define HOMING_IMAGE_FRAME_H_

#include <cstdint>
#include <opencv2/core.hpp>
#include <string_view>

#include "absl/status/statusor.h"
#include "homing/base/cancellation.h"

namespace homing {

enum class FrameEncoding { kGray8, kRgb8, kBgr8, kJpeg, kPng };

// Does not own its bytes.
struct Frame {
  FrameEncoding encoding = FrameEncoding::kGray8;
  // Pixels. Required for raw encodings; for JPEG and PNG 0, or the image header's value.
  int width = 0;
  int height = 0;
  std::string_view data;
};

// Checked against the header before anything is allocated.
struct DecodeLimits {
  int min_side_px = 16;
  int max_side_px = 8192;
  std::int64_t max_pixels = 16 * 1024 * 1024;
  // Ends decoding, and the tracking that follows, early. It must outlive every object that receives
  // these limits.
  const Cancellation* cancellation = nullptr;
};

// Grey image, CV_8UC1, height x width; it owns its pixels. Colour becomes 0.299 R + 0.587 G + 0.114
// B. 16-bit grey is stretched to the range that it uses. JPEG and PNG are turned by their EXIF
// orientation, so width and height may change places. INVALID_ARGUMENT: dimensions outside the
// limits or different from the header, wrong length of the data, or data that is no complete image.
// CANCELLED. Thread-safe.
absl::StatusOr<cv::Mat> DecodeGray(const Frame& frame, const DecodeLimits& limits = {});

// The size of that image, from the header alone, which costs no decoding: the data behind it may
// still be no complete image. INVALID_ARGUMENT as above. Thread-safe.
absl::StatusOr<cv::Size> MeasureGray(const Frame& frame, const DecodeLimits& limits = {});

}  // namespace homing

#endif  // HOMING_IMAGE_FRAME_H_
