#include "homing/image/jpeg_decoder.h"

#include <turbojpeg.h>

#include <memory>
#include <string>

#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"
#include "homing/image/dimensions.h"

namespace homing {
namespace {

struct HandleCloser {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using Handle = std::unique_ptr<void, HandleCloser>;

absl::Status JpegError(const Handle& handle) {
  return FieldError("frame.data",
                    absl::StrCat("is no complete JPEG image: ", tjGetErrorStr2(handle.get())));
}

}  // namespace

absl::StatusOr<cv::Mat> DecodeJpeg(const Frame& frame, const DecodeLimits& limits) {
  const Handle handle(tjInitDecompress());
  if (handle == nullptr) {
    return absl::InternalError("no JPEG decoder could be made");
  }
  const auto* bytes = reinterpret_cast<const unsigned char*>(frame.data.data());
  const auto length = static_cast<unsigned long>(frame.data.size());
  int width = 0;
  int height = 0;
  int subsampling = 0;
  int color_space = 0;
  if (tjDecompressHeader3(handle.get(), bytes, length, &width, &height, &subsampling,
                          &color_space) != 0) {
    return JpegError(handle);
  }
  if (width == 0) {
    return FieldError("frame.data", "is no complete JPEG image: it has no size");
  }
  HOMING_RETURN_IF_ERROR(CheckLimits({width, height}, limits));
  HOMING_RETURN_IF_ERROR(CheckDeclared(frame, {width, height}));
  cv::Mat gray(height, width, CV_8UC1);
  // A warning means invented pixels (a file that ends early): as bad as an error.
  constexpr int kFlags = TJFLAG_ACCURATEDCT | TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS;
  if (tjDecompress2(handle.get(), bytes, length, gray.data, width, static_cast<int>(gray.step[0]),
                    height, TJPF_GRAY, kFlags) != 0) {
    return JpegError(handle);
  }
  return gray;
}

}  // namespace homing
