// Uncompressed pixels (GRAY8, RGB8, BGR8) to grey.
#ifndef HOMING_IMAGE_RAW_DECODER_H_
#define HOMING_IMAGE_RAW_DECODER_H_

#include <opencv2/core.hpp>

#include "absl/status/statusor.h"
#include "homing/image/frame.h"

namespace homing {

// As DecodeGray, for the uncompressed encodings only.
absl::StatusOr<cv::Mat> DecodeRaw(const Frame& frame, const DecodeLimits& limits);
// As MeasureGray, for this encoding only.
absl::StatusOr<cv::Size> MeasureRaw(const Frame& frame, const DecodeLimits& limits);

}  // namespace homing

#endif  // HOMING_IMAGE_RAW_DECODER_H_
