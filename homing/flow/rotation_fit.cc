#include "homing/flow/rotation_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "homing/flow/median.h"

namespace homing {
namespace {

constexpr int kIterations = 10;
// A vector is explained if it is this near, pixels, or this share of what the rotation says.
constexpr double kNoisePx = 0.35;
constexpr double kNoiseShare = 0.15;

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

// Rows of design * rotation = flow, x components first, then y; all in focal lengths.
struct System {
  double focal = 0;
  Rows design;
  Eigen::VectorXd flow;
};

Intrinsics IntrinsicsOf(const FlowField& field, const Camera& camera) {
  if (camera.intrinsics.has_value()) {
    return *camera.intrinsics;
  }
  const double focal = 0.5 * field.width / std::tan(std::numbers::pi / 6);
  return {focal, focal, 0.5 * (field.width - 1), 0.5 * (field.height - 1)};
}

// u = pan (1 + x^2) + tilt x y + roll y;  v = pan x y + tilt (1 + y^2) - roll x.
System SystemOf(const FlowField& field, const Camera& camera) {
  const Intrinsics in = IntrinsicsOf(field, camera);
  const auto n = static_cast<Eigen::Index>(field.vectors.size());
  System system{in.focal_x, Rows(2 * n, 3), Eigen::VectorXd(2 * n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const FlowVector& vector = field.vectors[static_cast<std::size_t>(i)];
    const double x = (vector.MidX() - in.center_x) / in.focal_x;
    const double y = (vector.MidY() - in.center_y) / in.focal_y;
    system.design.row(i) << 1 + x * x, x * y, y;
    system.design.row(n + i) << x * y, 1 + y * y, -x;
    system.flow[i] = vector.FlowX() / in.focal_x;
    system.flow[n + i] = vector.FlowY() / in.focal_y;
  }
  return system;
}

// Length of the residual of each vector, pixels.
std::vector<double> Residuals(const System& system, const Eigen::Vector3d& rotation) {
  const Eigen::VectorXd miss = system.focal * (system.flow - system.design * rotation);
  const Eigen::Index n = miss.size() / 2;
  std::vector<double> result(static_cast<std::size_t>(n));
  for (Eigen::Index i = 0; i < n; ++i) {
    result[static_cast<std::size_t>(i)] = std::sqrt(miss[i] * miss[i] + miss[n + i] * miss[n + i]);
  }
  return result;
}

// Weights that fade beyond the median residual, one a row.
Eigen::VectorXd Weights(const std::vector<double>& residuals) {
  const double scale = 1.5 * Median(residuals) + 1e-6;
  const auto n = static_cast<Eigen::Index>(residuals.size());
  Eigen::VectorXd weights(2 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double ratio = residuals[static_cast<std::size_t>(i)] / scale;
    weights[i] = 1 / ((1 + ratio * ratio) * (1 + ratio * ratio));
    weights[n + i] = weights[i];
  }
  return weights;
}

// Weighted least squares. The sums are written out: products of so narrow matrices cost five times
// as much.
Eigen::Vector3d SolveWeighted(const System& system, const Eigen::VectorXd& weights) {
  double aa = 0, ab = 0, ac = 0, bb = 0, bc = 0, cc = 0, af = 0, bf = 0, cf = 0;
  for (Eigen::Index row = 0; row < weights.size(); ++row) {
    const double a = system.design(row, 0);
    const double b = system.design(row, 1);
    const double c = system.design(row, 2);
    const double weighted_a = weights[row] * a;
    const double weighted_b = weights[row] * b;
    const double weighted_c = weights[row] * c;
    aa += weighted_a * a;
    ab += weighted_a * b;
    ac += weighted_a * c;
    bb += weighted_b * b;
    bc += weighted_b * c;
    cc += weighted_c * c;
    af += weighted_a * system.flow[row];
    bf += weighted_b * system.flow[row];
    cf += weighted_c * system.flow[row];
  }
  Eigen::Matrix3d normal;
  normal << aa, ab, ac, ab, bb, bc, ac, bc, cc;
  // A trace of damping keeps the few-vector case solvable.
  normal += 1e-9 * Eigen::Matrix3d::Identity();
  return normal.ldlt().solve(Eigen::Vector3d(af, bf, cf));
}

Eigen::Vector3d SolveRotation(const System& system) {
  const Eigen::Index n = system.flow.size() / 2;
  std::vector<double> u(system.flow.data(), system.flow.data() + n);
  std::vector<double> v(system.flow.data() + n, system.flow.data() + 2 * n);
  Eigen::Vector3d rotation(Median(std::move(u)), Median(std::move(v)), 0);
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::VectorXd weights = Weights(Residuals(system, rotation));
    rotation = SolveWeighted(system, weights);
  }
  return rotation;
}

// Weighted least squares on the vertical components alone.
void FitVertical(const System& system, const Eigen::VectorXd& all_weights, RotationFit& fit) {
  const Eigen::Index n = system.flow.size() / 2;
  const Rows design = system.design.bottomRows(n);
  const Eigen::VectorXd flow = system.flow.tail(n);
  const Eigen::VectorXd weights = all_weights.tail(n);
  const Eigen::Matrix3d normal =
      design.transpose() * weights.asDiagonal() * design + 1e-9 * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d inverse = normal.inverse();
  const Eigen::Vector3d rotation = inverse * (design.transpose() * (weights.asDiagonal() * flow));
  const Eigen::VectorXd miss = flow - design * rotation;
  const double variance = miss.dot(weights.asDiagonal() * miss) / weights.sum();
  fit.vertical_pan = rotation[0];
  fit.vertical_pan_error = std::sqrt(variance * inverse(0, 0));
}

}  // namespace

RotationFit FitRotation(const FlowField& field, const Camera& camera) {
  const System system = SystemOf(field, camera);
  const Eigen::Vector3d rotation = SolveRotation(system);
  const std::vector<double> residuals = Residuals(system, rotation);
  const std::vector<double> predicted =
      Residuals({system.focal, system.design, Eigen::VectorXd::Zero(system.flow.size())}, rotation);
  RotationFit fit;
  fit.pan = rotation[0];
  FitVertical(system, Weights(residuals), fit);
  std::size_t explained = 0;
  std::vector<double> lengths;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    explained += residuals[i] <= std::max(kNoisePx, kNoiseShare * predicted[i]) ? 1U : 0U;
    lengths.push_back(field.vectors[i].Length());
  }
  fit.explained = static_cast<double>(explained) / static_cast<double>(residuals.size());
  fit.median_residual = Median(residuals);
  fit.median_length = Median(std::move(lengths));
  return fit;
}

}  // namespace homing
