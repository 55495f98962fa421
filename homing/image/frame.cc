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
  return MustBe("frame.encoding", static_cast<int>(frame.encoding),
                "GRAY8, RGB8, BGR8, JPEG or PNG");
}

}  // namespace

absl::StatusOr<cv::Mat> DecodeGray(const Frame& frame, const DecodeLimits& limits) {
  // OpenCV throws when memory runs out; no exception leaves this folder.
  try {
    HOMING_RETURN_IF_ERROR(CheckAwaited(limits.cancellation));
    absl::StatusOr<cv::Mat> gray = Decode(frame, limits);
    const bool file =
        frame.encoding == FrameEncoding::kJpeg || frame.encoding == FrameEncoding::kPng;
    if (!gray.ok() || !file) return gray;
    return TurnUpright(*gray, ExifOrientation(frame.data));
  } catch (const cv::Exception& error) {
    return absl::ResourceExhaustedError(absl::StrCat("frame could not be decoded: ", error.err));
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError("out of memory while decoding the frame");
  }
}

}  // namespace homing
