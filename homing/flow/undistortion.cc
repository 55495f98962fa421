#include "homing/flow/undistortion.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace homing {
namespace {

constexpr int kMaxSteps = 30;
// Accuracy of the inverse, focal lengths: far finer than a pixel in float, since focal lengths are
// below 1e6 px.
constexpr double kTolerance = 1e-11;

// (1 + k1 r2 + k2 r2^2 + k3 r2^3) / (1 + k4 r2 + k5 r2^2 + k6 r2^3), and its derivative by r2.
struct Radial {
  double factor;
  double slope;
};

Radial RadialAt(double r2, const Distortion& d) {
  const double above = 1 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]));
  const double above_slope = d[0] + r2 * (2 * d[1] + r2 * 3 * d[4]);
  const double below = 1 + r2 * (d[5] + r2 * (d[6] + r2 * d[7]));
  const double below_slope = d[5] + r2 * (2 * d[6] + r2 * 3 * d[7]);
  return {above / below, (above_slope * below - above * below_slope) / (below * below)};
}

// Distance from the centre of a ray at this angle from the axis of a fisheye lens, and its
// derivative.
struct FisheyeRadius {
  double radius;
  double slope;
};

FisheyeRadius FisheyeAt(double angle, const Distortion& d) {
  const double a2 = angle * angle;
  return {angle * (1 + a2 * (d[0] + a2 * (d[1] + a2 * (d[2] + a2 * d[3])))),
          1 + a2 * (3 * d[0] + a2 * (5 * d[1] + a2 * (7 * d[2] + a2 * 9 * d[3])))};
}

Eigen::Matrix2d JacobianAt(const Eigen::Vector2d& ray, const Distortion& d) {
  const double x = ray.x();
  const double y = ray.y();
  const Radial radial = RadialAt(ray.squaredNorm(), d);
  const double cross = 2 * x * y * radial.slope + 2 * d[2] * x + 2 * d[3] * y;
  Eigen::Matrix2d jacobian;
  jacobian << radial.factor + 2 * x * x * radial.slope + 2 * d[2] * y + 6 * d[3] * x, cross,  //
      cross, radial.factor + 2 * y * y * radial.slope + 6 * d[2] * y + 2 * d[3] * x;
  return jacobian;
}

}  // namespace

Eigen::Vector2d Distort(const Eigen::Vector2d& ray, const Distortion& d) {
  const double x = ray.x();
  const double y = ray.y();
  const double r2 = ray.squaredNorm();
  const double factor = RadialAt(r2, d).factor;
  return {x * factor + 2 * d[2] * x * y + d[3] * (r2 + 2 * x * x),
          y * factor + d[2] * (r2 + 2 * y * y) + 2 * d[3] * x * y};
}

std::optional<Eigen::Vector2d> Undistort(const Eigen::Vector2d& shown,
                                         const Distortion& distortion) {
  Eigen::Vector2d ray = shown;
  for (int i = 0; i < kMaxSteps; ++i) {
    const Eigen::Vector2d miss = Distort(ray, distortion) - shown;
    const Eigen::Matrix2d jacobian = JacobianAt(ray, distortion);
    // Not positive: beyond the fold of the model, where two rays would be shown at one point.
    if (!(jacobian.determinant() > 0)) {
      return std::nullopt;
    }
    if (miss.norm() < kTolerance) {
      return ray;
    }
    ray -= jacobian.inverse() * miss;
  }
  return std::nullopt;
}

Eigen::Vector2d DistortFisheye(const Eigen::Vector2d& ray, const Distortion& d) {
  const double distance = ray.norm();
  if (distance == 0) {
    return ray;
  }
  return ray * (FisheyeAt(std::atan(distance), d).radius / distance);
}

std::optional<Eigen::Vector2d> UndistortFisheye(const Eigen::Vector2d& shown,
                                                const Distortion& distortion) {
  const double distance = shown.norm();
  if (distance == 0) {
    return shown;
  }
  double angle = std::min(distance, std::numbers::pi / 2);
  for (int i = 0; i < kMaxSteps; ++i) {
    const FisheyeRadius at = FisheyeAt(angle, distortion);
    // Not positive: beyond the fold of the model.
    if (!(at.slope > 0)) {
      return std::nullopt;
    }
    const double miss = at.radius - distance;
    if (std::abs(miss) < kTolerance) {
      if (!(angle > 0 && angle < std::numbers::pi / 2)) {
        return std::nullopt;
      }
      return shown * (std::tan(angle) / distance);
    }
    angle -= miss / at.slope;
  }
  return std::nullopt;
}

}  // namespace homing
