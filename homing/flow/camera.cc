#include "homing/flow/camera.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "absl/strings/str_cat.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"
#include "homing/flow/undistortion.h"

namespace homing {
namespace {

constexpr int kMaxSidePx = 65536;
constexpr double kMaxLengthPx = 1e6;
constexpr double kMaxDistortion = 100;
// The ideal camera does not see rays with a depth below this.
constexpr double kMinDepth = 1e-3;

absl::Status CheckSize(const Camera& camera) {
  HOMING_RETURN_IF_ERROR(CheckRange("width", camera.width, 0, kMaxSidePx, "px"));
  HOMING_RETURN_IF_ERROR(CheckRange("height", camera.height, 0, kMaxSidePx, "px"));
  if ((camera.width == 0) != (camera.height == 0)) {
    return MustBe("width", absl::StrCat(camera.width, " x ", camera.height),
                  "both sides, or 0 x 0 px");
  }
  return absl::OkStatus();
}

absl::Status CheckIntrinsics(const Intrinsics& intrinsics) {
  HOMING_RETURN_IF_ERROR(CheckAbove("focal_x", intrinsics.focal_x, 0.0, kMaxLengthPx, "px"));
  HOMING_RETURN_IF_ERROR(CheckAbove("focal_y", intrinsics.focal_y, 0.0, kMaxLengthPx, "px"));
  HOMING_RETURN_IF_ERROR(
      CheckRange("center_x", intrinsics.center_x, -kMaxLengthPx, kMaxLengthPx, "px"));
  return CheckRange("center_y", intrinsics.center_y, -kMaxLengthPx, kMaxLengthPx, "px");
}

bool IsDistorted(const Camera& camera) {
  return camera.fisheye || std::any_of(camera.distortion.begin(), camera.distortion.end(),
                                       [](double k) { return k != 0; });
}

// The point of the ideal camera's image for a point of the raw image; nothing if it cannot see it.
std::optional<Eigen::Vector2d> IdealPoint(const Camera& camera, double x, double y) {
  const Intrinsics& in = *camera.intrinsics;
  const Eigen::Vector2d distorted((x - in.center_x) / in.focal_x, (y - in.center_y) / in.focal_y);
  const auto ray = camera.fisheye ? UndistortFisheye(distorted, camera.distortion)
                                  : Undistort(distorted, camera.distortion);
  if (!ray) {
    return std::nullopt;
  }
  // Turned by the yaw about the vertical axis: x right, y down, z ahead.
  const double c = std::cos(camera.yaw_rad);
  const double s = std::sin(camera.yaw_rad);
  const double depth = c - s * ray->x();
  if (!(depth > kMinDepth)) {
    return std::nullopt;
  }
  return Eigen::Vector2d(in.center_x + in.focal_x * (c * ray->x() + s) / depth,
                         in.center_y + in.focal_y * ray->y() / depth);
}

bool IsFinite(const FlowVector& v) {
  return std::isfinite(v.start_x) && std::isfinite(v.start_y) && std::isfinite(v.end_x) &&
         std::isfinite(v.end_y);
}

bool IsOnImage(const Eigen::Vector2d& p, const FlowField& field) {
  return p.x() >= -0.5 && p.x() < field.width - 0.5 && p.y() >= -0.5 && p.y() < field.height - 0.5;
}

std::optional<FlowVector> IdealVector(const FlowVector& raw, const FlowField& field,
                                      const Camera& camera) {
  const auto start = IdealPoint(camera, raw.start_x, raw.start_y);
  const auto end = IdealPoint(camera, raw.end_x, raw.end_y);
  if (!start || !end || !IsOnImage(*start, field) || !IsOnImage(*end, field)) {
    return std::nullopt;
  }
  return FlowVector{static_cast<float>(start->x()), static_cast<float>(start->y()),
                    static_cast<float>(end->x()), static_cast<float>(end->y())};
}

}  // namespace

absl::Status Validate(const Camera& camera) {
  HOMING_RETURN_IF_ERROR(CheckSize(camera));
  constexpr double kQuarterTurn = std::numbers::pi / 2;
  if (!(std::abs(camera.yaw_rad) < kQuarterTurn)) {
    return MustBe("yaw_rad", camera.yaw_rad, "in (-pi/2, pi/2) rad");
  }
  for (const double k : camera.distortion) {
    HOMING_RETURN_IF_ERROR(CheckRange("distortion", k, -kMaxDistortion, kMaxDistortion));
  }
  if (camera.intrinsics.has_value()) {
    return CheckIntrinsics(*camera.intrinsics);
  }
  if (IsDistorted(camera) || camera.yaw_rad != 0) {
    return FieldError("focal_x", "must be given for a camera with distortion or yaw_rad");
  }
  return absl::OkStatus();
}

double UsualFocal(int width) { return 0.5 * width / std::tan(std::numbers::pi / 6); }

FlowField Rectify(const FlowField& raw, const Camera& camera) {
  const bool ideal =
      !camera.intrinsics.has_value() || (!IsDistorted(camera) && camera.yaw_rad == 0);
  if (ideal && std::ranges::all_of(raw.vectors, IsFinite)) {
    return raw;
  }
  FlowField result{raw.width, raw.height, {}};
  result.vectors.reserve(raw.vectors.size());
  for (const FlowVector& v : raw.vectors) {
    if (!IsFinite(v)) {
      continue;
    }
    if (const auto kept = ideal ? v : IdealVector(v, raw, camera)) {
      result.vectors.push_back(*kept);
    }
  }
  return result;
}

}  // namespace homing
