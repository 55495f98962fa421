#include "homing/flow/vertical_turn.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "homing/flow/motion.h"

namespace homing {
namespace {

// Of the vertical flow, pixels: at first, and at least.
constexpr double kFirstNoisePx = 1.0;
constexpr double kLeastNoisePx = 0.1;

}  // namespace

VerticalTurn ReadVerticalTurn(const FlowField& field, const Camera& camera) {
  const auto& in = camera.intrinsics;
  const double focal = in ? in->focal_x : UsualFocal(field.width);
  const double center_x = in ? in->center_x : 0.5 * (field.width - 1);
  const double center_y = in ? in->center_y : 0.5 * (field.height - 1);
  // v = turn x y + tilt (1 + y^2) - roll x, in focal lengths; then again without what lies far
  // off.
  Eigen::Vector3d fit = Eigen::Vector3d::Zero();
  double noise = kFirstNoisePx / focal;
  for (int pass = 0; pass < 3; ++pass) {
    Eigen::Matrix3d normal = 1e-9 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double squares = 0;
    std::size_t used = 0;
    for (const FlowVector& v : field.vectors) {
      const double x = (v.MidX() - center_x) / focal, y = (v.MidY() - center_y) / focal;
      const Eigen::Vector3d row(x * y, 1 + y * y, -x);
      const double error = v.FlowY() / focal - row.dot(fit);
      if (!(std::abs(error) < 3 * noise)) continue;
      normal += row * row.transpose();
      right += row * (v.FlowY() / focal);
      squares += error * error;
      ++used;
    }
    if (used < kMinVectors) return {};
    fit = normal.ldlt().solve(right);
    if (pass > 0)
      noise = std::max(kLeastNoisePx / focal, std::sqrt(squares / static_cast<double>(used)));
    if (pass == 2) {
      const double variance = noise * noise * normal.inverse()(0, 0);
      if (variance > 0 && std::isfinite(fit[0])) return {fit[0], variance};
    }
  }
  return {};
}

VerticalTurn ReadVerticalTurn(const ObservedFlow& flow, const std::array<Camera, 2>& cameras) {
  double weight = 0, sum = 0;
  for (std::size_t camera = 0; camera < 2; ++camera) {
    if (!flow.fields[camera]) continue;
    const VerticalTurn one = ReadVerticalTurn(*flow.fields[camera], cameras[camera]);
    weight += 1 / one.variance;
    sum += one.turn / one.variance;
  }
  return weight > 0 ? VerticalTurn{sum / weight, 1 / weight} : VerticalTurn{};
}

}  // namespace homing
