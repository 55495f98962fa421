#include "homing/flow/camera.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "homing/flow/undistortion.h"

namespace homing {
namespace {

constexpr int kMaxSidePx = 65536;
constexpr double kMaxLengthPx = 1e6;
constexpr double kMaxDistortion = 100;
// Rays nearer than this to the plane of the ideal camera are out of its sight.
constexpr double kMinDepth = 1e-3;

absl::Status CheckBetween(const std::string& field, double value, double low, double high) {
  if (value > low && value < high) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat("camera.", field, " ", value, " is outside (", low, ", ", high, ")"));
}

absl::Status CheckSize(const Camera& camera) {
  HOMING_RETURN_IF_ERROR(CheckBetween("width", camera.width, -1, kMaxSidePx + 1));
  HOMING_RETURN_IF_ERROR(CheckBetween("height", camera.height, -1, kMaxSidePx + 1));
  if ((camera.width == 0) != (camera.height == 0)) {
    return absl::InvalidArgumentError(absl::StrCat("camera.width ", camera.width,
                                                   " and camera.height ", camera.height,
                                                   " must both be given or both be 0"));
  }
  return absl::OkStatus();
}

absl::Status CheckIntrinsics(const Intrinsics& intrinsics) {
  HOMING_RETURN_IF_ERROR(CheckBetween("focal_x", intrinsics.focal_x, 0, kMaxLengthPx));
  HOMING_RETURN_IF_ERROR(CheckBetween("focal_y", intrinsics.focal_y, 0, kMaxLengthPx));
  HOMING_RETURN_IF_ERROR(
      CheckBetween("center_x", intrinsics.center_x, -kMaxLengthPx, kMaxLengthPx));
  return CheckBetween("center_y", intrinsics.center_y, -kMaxLengthPx, kMaxLengthPx);
}

bool IsDistorted(const Camera& camera) {
  return camera.fisheye || std::any_of(camera.distortion.begin(), camera.distortion.end(),
                                       [](double k) { return k != 0; });
}

// A point of the raw image in the ideal camera's image; nothing where that cannot see it.
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
  HOMING_RETURN_IF_ERROR(CheckBetween("yaw_rad", camera.yaw_rad, -kQuarterTurn, kQuarterTurn));
  for (const double k : camera.distortion) {
    HOMING_RETURN_IF_ERROR(CheckBetween("distortion", k, -kMaxDistortion, kMaxDistortion));
  }
  if (camera.intrinsics.has_value()) {
    return CheckIntrinsics(*camera.intrinsics);
  }
  if (IsDistorted(camera) || camera.yaw_rad != 0) {
    return absl::InvalidArgumentError(
        absl::StrCat("camera.distortion and camera.yaw_rad ", camera.yaw_rad,
                     " need camera.focal_x, focal_y, center_x and center_y"));
  }
  return absl::OkStatus();
}

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
