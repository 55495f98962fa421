#include "homing/image/frame.h"

#include <new>
#include <string>

#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"
#include "homing/image/jpeg_decoder.h"
#include "homing/image/orientation.h"
#include "homing/image/png_decoder.h"
#include "homing/image/raw_decoder.h"

namespace homing {
namespace {

absl::Status UnknownEncoding(const Frame& frame) {
  return MustBe("frame.encoding", static_cast<int>(frame.encoding),
                "GRAY8, RGB8, BGR8, JPEG or PNG");
}

absl::StatusOr<cv::Mat> Decode(const Frame& frame, const DecodeLimits& limits) {
  switch (frame.encoding) {
    case FrameEncoding::kGray8:
    case FrameEncoding::kRgb8:
    case FrameEncoding::kBgr8:
      return DecodeRaw(frame, limits);
    case FrameEncoding::kJpeg:
      return DecodeJpeg(frame, limits);
    case FrameEncoding::kPng:
      return DecodePng(frame, limits);
  }
  return UnknownEncoding(frame);
}

absl::StatusOr<cv::Size> Measure(const Frame& frame, const DecodeLimits& limits) {
  switch (frame.encoding) {
    case FrameEncoding::kGray8:
    case FrameEncoding::kRgb8:
    case FrameEncoding::kBgr8:
      return MeasureRaw(frame, limits);
    case FrameEncoding::kJpeg:
      return MeasureJpeg(frame, limits);
    case FrameEncoding::kPng:
      return MeasurePng(frame, limits);
  }
  return UnknownEncoding(frame);
}

bool IsFile(const Frame& frame) {
  return frame.encoding == FrameEncoding::kJpeg || frame.encoding == FrameEncoding::kPng;
}

}  // namespace

absl::StatusOr<cv::Mat> DecodeGray(const Frame& frame, const DecodeLimits& limits) {
  // OpenCV throws when memory runs out; no exception leaves this folder.
  try {
    HOMING_RETURN_IF_ERROR(CheckAwaited(limits.cancellation));
    absl::StatusOr<cv::Mat> gray = Decode(frame, limits);
    if (!gray.ok() || !IsFile(frame)) return gray;
    return TurnUpright(*gray, ExifOrientation(frame.data));
  } catch (const cv::Exception& error) {
    return absl::ResourceExhaustedError(absl::StrCat("frame could not be decoded: ", error.err));
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError("out of memory while decoding the frame");
  }
}

absl::StatusOr<cv::Size> MeasureGray(const Frame& frame, const DecodeLimits& limits) {
  absl::StatusOr<cv::Size> size = Measure(frame, limits);
  if (!size.ok() || !IsFile(frame) || !ExchangesSides(ExifOrientation(frame.data))) return size;
  return cv::Size(size->height, size->width);
}

}  // namespace homing
