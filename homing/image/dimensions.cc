#include "homing/image/dimensions.h"

#include <string>

#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/limit_error.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"

namespace homing {
namespace {

absl::Status CheckSide(const std::string& field, std::int64_t side, const DecodeLimits& limits) {
  return CheckRange<std::int64_t>(field, side, limits.min_side_px, limits.max_side_px, "px");
}

absl::Status CheckSame(const std::string& field, std::int64_t declared, std::int64_t header) {
  if (declared == 0 || declared == header) {
    return absl::OkStatus();
  }
  return MustBe(field, declared, absl::StrCat("0 or the image header's ", header, " px"));
}

}  // namespace

absl::Status CheckLimits(const Dimensions& dimensions, const DecodeLimits& limits) {
  HOMING_RETURN_IF_ERROR(CheckSide("frame.width", dimensions.width, limits));
  HOMING_RETURN_IF_ERROR(CheckSide("frame.height", dimensions.height, limits));
  if (dimensions.width * dimensions.height > limits.max_pixels) {
    return LimitError("PIXELS", "frame", absl::StrCat(dimensions.width, " x ", dimensions.height),
                      absl::StrCat("at most ", limits.max_pixels, " pixels"));
  }
  return absl::OkStatus();
}

absl::Status CheckDeclared(const Frame& frame, const Dimensions& header) {
  HOMING_RETURN_IF_ERROR(CheckSame("frame.width", frame.width, header.width));
  return CheckSame("frame.height", frame.height, header.height);
}

}  // namespace homing
