// JPEG bytes to grey.
#ifndef HOMING_IMAGE_JPEG_DECODER_H_
#define HOMING_IMAGE_JPEG_DECODER_H_

#include <opencv2/core.hpp>

#include "absl/status/statusor.h"
#include "homing/image/frame.h"

namespace homing {

// As DecodeGray, for this encoding only.
absl::StatusOr<cv::Mat> DecodeJpeg(const Frame& frame, const DecodeLimits& limits);
// As MeasureGray, for this encoding only, before the image is turned.
absl::StatusOr<cv::Size> MeasureJpeg(const Frame& frame, const DecodeLimits& limits);

}  // namespace homing

#endif  // HOMING_IMAGE_JPEG_DECODER_H_
