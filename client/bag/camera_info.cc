#include "client/bag/camera_info.h"

#include <algorithm>
#include <array>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

constexpr std::size_t kMatrixValues = 9;
constexpr std::size_t kProjectionValues = 12;

// fx 0 cx (0) 0 fy cy (0) ...
absl::StatusOr<Intrinsics> ReadMatrix(const std::vector<double>& values, std::size_t columns) {
  Intrinsics in;
  if (values.size() == columns * 3) {
    in = {values[0], values[columns + 1], values[2], values[columns + 2]};
  }
  if (in.focal_x > 0 && in.focal_y > 0) return in;
  return absl::InvalidArgumentError("the camera has no focal length; it is not calibrated");
}

absl::Status SetDistortion(const CameraInfo& info, Camera* camera) {
  const std::string& model = info.distortion_model;
  constexpr std::array<const char*, 3> kFisheye = {"equidistant", "fisheye", "kannala_brandt"};
  camera->fisheye = std::find(kFisheye.begin(), kFisheye.end(), model) != kFisheye.end();
  std::size_t most = camera->fisheye ? 4 : camera->distortion.size();
  if (model == "plumb_bob" || model == "radtan") most = 5;
  if (!camera->fisheye && std::all_of(info.distortion.begin(), info.distortion.end(),
                                      [](double k) { return k == 0; })) {
    return absl::OkStatus();
  }
  constexpr std::array<const char*, 4> kKnown = {"plumb_bob", "radtan", "rational_polynomial", ""};
  if (!camera->fisheye && std::find(kKnown.begin(), kKnown.end(), model) == kKnown.end()) {
    return absl::InvalidArgumentError(
        absl::StrCat("the distortion model \"", model, "\" is not supported"));
  }
  const auto beyond =
      info.distortion.begin() + static_cast<std::ptrdiff_t>(std::min(most, info.distortion.size()));
  if (std::any_of(beyond, info.distortion.end(), [](double k) { return k != 0; })) {
    return absl::InvalidArgumentError(absl::StrCat("the distortion model \"", model, "\" has ",
                                                   info.distortion.size(), " values, at most ",
                                                   most, " are supported"));
  }
  std::copy(info.distortion.begin(), beyond, camera->distortion.begin());
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<Camera> ToCamera(const CameraInfo& info, bool rectified) {
  Camera camera;
  camera.width = static_cast<int>(std::min<std::uint32_t>(info.width, 1U << 30));
  camera.height = static_cast<int>(std::min<std::uint32_t>(info.height, 1U << 30));
  if (rectified) {
    HOMING_ASSIGN_OR_RETURN(camera.intrinsics, ReadMatrix(info.projection, kProjectionValues / 3));
  } else {
    HOMING_ASSIGN_OR_RETURN(camera.intrinsics, ReadMatrix(info.matrix, kMatrixValues / 3));
    HOMING_RETURN_IF_ERROR(SetDistortion(info, &camera));
  }
  if (const absl::Status valid = Validate(camera); !valid.ok()) {
    return absl::InvalidArgumentError(absl::StrCat("the camera's ", std::string(valid.message())));
  }
  return camera;
}

}  // namespace homing::client
