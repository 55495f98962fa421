#include "homing/image/raw_decoder.h"

#include <opencv2/imgproc.hpp>

#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"
#include "homing/image/dimensions.h"

namespace homing {

absl::StatusOr<cv::Size> MeasureRaw(const Frame& frame, const DecodeLimits& limits) {
  HOMING_RETURN_IF_ERROR(CheckLimits({frame.width, frame.height}, limits));
  const bool gray = frame.encoding == FrameEncoding::kGray8;
  const std::size_t expected = static_cast<std::size_t>(frame.width) *
                               static_cast<std::size_t>(frame.height) * (gray ? 1U : 3U);
  if (frame.data.size() != expected) {
    return MustBe("frame.data", frame.data.size(),
                  absl::StrCat(expected, " bytes: ", frame.width, " x ", frame.height,
                               gray ? " x 1" : " x 3"));
  }
  return cv::Size(frame.width, frame.height);
}

absl::StatusOr<cv::Mat> DecodeRaw(const Frame& frame, const DecodeLimits& limits) {
  HOMING_ASSIGN_OR_RETURN(const cv::Size size, MeasureRaw(frame, limits));
  const bool gray = frame.encoding == FrameEncoding::kGray8;
  // cv::Mat has no constructor for const data; the view is only read.
  void* bytes = const_cast<char*>(frame.data.data());
  const cv::Mat view(size, gray ? CV_8UC1 : CV_8UC3, bytes);
  if (gray) {
    return view.clone();
  }
  cv::Mat result;
  const bool rgb = frame.encoding == FrameEncoding::kRgb8;
  cv::cvtColor(view, result, rgb ? cv::COLOR_RGB2GRAY : cv::COLOR_BGR2GRAY);
  return result;
}

}  // namespace homing
