#include "homing/flow/vertical_turn.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "homing/flow/motion.h"

namespace homing {
namespace {

// Noise of the vertical flow, pixels: in the first pass, and at least.
constexpr double kFirstNoisePx = 1.0;
constexpr double kLeastNoisePx = 0.1;

// Midpoint and vertical flow of a vector, focal lengths from the middle.
struct Point {
  double x = 0;
  double y = 0;
  double flow = 0;
};

std::vector<Point> PointsOf(const FlowField& field, const Camera& camera, double focal) {
  const auto& in = camera.intrinsics;
  const double center_x = in ? in->center_x : 0.5 * (field.width - 1);
  const double center_y = in ? in->center_y : 0.5 * (field.height - 1);
  const double per_focal = 1 / focal;
  std::vector<Point> points;
  points.reserve(field.vectors.size());
  for (const FlowVector& v : field.vectors) {
    points.push_back({(v.MidX() - center_x) * per_focal, (v.MidY() - center_y) * per_focal,
                      v.FlowY() * per_focal});
  }
  return points;
}

}  // namespace

VerticalTurn ReadVerticalTurn(const FlowField& field, const Camera& camera) {
  const double focal = camera.intrinsics ? camera.intrinsics->focal_x : UsualFocal(field.width);
  const std::vector<Point> points = PointsOf(field, camera, focal);
  // Fits v = turn x y + tilt (1 + y^2) - roll x, in focal lengths; then again without the vectors
  // that lie more than three deviations off.
  Eigen::Vector3d fit = Eigen::Vector3d::Zero();
  double noise = kFirstNoisePx / focal;
  for (int pass = 0; pass < 3; ++pass) {
    // The sums of the normal equations are separate variables, as in FitVertical of
    // rotation_fit.cc: a matrix would be written to memory and read again for each vector, which
    // takes five times as long.
    double aa = 1e-9, bb = 1e-9, cc = 1e-9, ab = 0, ac = 0, bc = 0, av = 0, bv = 0, cv = 0;
    double squares = 0;
    std::size_t used = 0;
    for (const Point& point : points) {
      const double a = point.x * point.y, b = 1 + point.y * point.y, c = -point.x, v = point.flow;
      const double error = v - (a * fit[0] + b * fit[1] + c * fit[2]);
      if (!(std::abs(error) < 3 * noise)) continue;
      aa += a * a;
      bb += b * b;
      cc += c * c;
      ab += a * b;
      ac += a * c;
      bc += b * c;
      av += a * v;
      bv += b * v;
      cv += c * v;
      squares += error * error;
      ++used;
    }
    if (used < kMinVectors) return {};
    Eigen::Matrix3d normal;
    normal << aa, ab, ac, ab, bb, bc, ac, bc, cc;
    const Eigen::LDLT<Eigen::Matrix3d> factors(normal);
    fit = factors.solve(Eigen::Vector3d(av, bv, cv));
    if (pass > 0)
      noise = std::max(kLeastNoisePx / focal, std::sqrt(squares / static_cast<double>(used)));
    if (pass == 2) {
      const double variance = noise * noise * factors.solve(Eigen::Vector3d::UnitX())[0];
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
