#include "homing/flow/rotation_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "homing/base/vector_clones.h"
#include "homing/flow/median.h"

namespace homing {
namespace {

constexpr int kMaxIterations = 10;
// The iteration ends at a change this small, pixels.
constexpr double kConvergedPx = 0.01;
// A vector is explained if it is this near, pixels, or within this fraction
// of the flow of the rotation.
constexpr double kNoisePx = 0.35;
constexpr double kNoiseShare = 0.15;
// A little damping keeps the system solvable with few vectors.
constexpr double kDamping = 1e-9;
// Sums are added in this many lanes, so that they are bit-identical on every machine.
constexpr std::size_t kLanes = 4;

Intrinsics IntrinsicsOf(const FlowField& field, const Camera& camera) {
  if (camera.intrinsics.has_value()) {
    return *camera.intrinsics;
  }
  const double focal = UsualFocal(field.width);
  return {focal, focal, 0.5 * (field.width - 1), 0.5 * (field.height - 1)};
}

// A vector's two equations, by column, all in focal lengths:
// u = pan (1 + x^2) + tilt x y + roll y;  v = pan x y + tilt (1 + y^2) - roll x.
struct System {
  System(const FlowField& field, const Camera& camera);

  double focal = 0;
  // Number of vectors. The columns are padded with zeros to whole lanes.
  std::size_t size = 0;
  std::vector<double> x, y, u, v;
  double median_u = 0;
  double median_v = 0;
};

// One row a vector; flows also in float, for their medians.
HOMING_VECTOR_CLONES
void FillColumns(std::span<const FlowVector> vectors, const Intrinsics& in, double* __restrict x,
                 double* __restrict y, double* __restrict u, double* __restrict v,
                 float* __restrict float_u, float* __restrict float_v) {
  const FlowVector* const from = vectors.data();
  const double center_x = in.center_x, center_y = in.center_y;
  const double per_x = 1 / in.focal_x, per_y = 1 / in.focal_y;
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    x[i] = (from[i].MidX() - center_x) * per_x;
    y[i] = (from[i].MidY() - center_y) * per_y;
    u[i] = from[i].FlowX() * per_x;
    v[i] = from[i].FlowY() * per_y;
    float_u[i] = static_cast<float>(u[i]);
    float_v[i] = static_cast<float>(v[i]);
  }
}

HOMING_VECTOR_CLONES
void FillLengths(std::span<const FlowVector> vectors, float* __restrict lengths) {
  const FlowVector* const from = vectors.data();
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    lengths[i] = static_cast<float>(from[i].Length());
  }
}

System::System(const FlowField& field, const Camera& camera) : size(field.vectors.size()) {
  const Intrinsics in = IntrinsicsOf(field, camera);
  focal = in.focal_x;
  const std::size_t padded = (size + kLanes - 1) / kLanes * kLanes;
  for (std::vector<double>* const column : {&x, &y, &u, &v}) {
    column->resize(padded);
  }
  std::vector<float> all_u(size);
  std::vector<float> all_v(size);
  FillColumns(field.vectors, in, x.data(), y.data(), u.data(), v.data(), all_u.data(),
              all_v.data());
  median_u = Median(all_u);
  median_v = Median(all_v);
}

// Pan, tilt, roll; radians a step.
using Rotation = Eigen::Vector3d;

// Squared residual of each vector, in focal lengths.
HOMING_VECTOR_CLONES
void SquaredResiduals(const System& system, const Rotation& rotation, float* squares) {
  const double pan = rotation[0], tilt = rotation[1], roll = rotation[2];
  const double* const x = system.x.data();
  const double* const y = system.y.data();
  const double* const u = system.u.data();
  const double* const v = system.v.data();
  for (std::size_t i = 0; i < system.size; ++i) {
    const double xy = x[i] * y[i];
    const double miss_u = u[i] - (pan * (1 + x[i] * x[i]) + tilt * xy + roll * y[i]);
    const double miss_v = v[i] - (pan * xy + tilt * (1 + y[i] * y[i]) - roll * x[i]);
    squares[i] = static_cast<float>(miss_u * miss_u + miss_v * miss_v);
  }
}

// Weights that fall beyond 1.5 times the median residual.
HOMING_VECTOR_CLONES
void FadingWeights(const float* squares, std::size_t size, double scale, double* weights) {
  const double per_square = 1 / (scale * scale);
  for (std::size_t i = 0; i < size; ++i) {
    const double faded = 1 + squares[i] * per_square;
    weights[i] = 1 / (faded * faded);
  }
}

// Indices of the sums of the weighted normal equations.
enum Sum { kAA, kAB, kAC, kBB, kBC, kCC, kAF, kBF, kCF, kSums };

HOMING_VECTOR_CLONES
void AddUp(const System& system, const double* weights, double* sums) {
  const double* const x = system.x.data();
  const double* const y = system.y.data();
  const double* const u = system.u.data();
  const double* const v = system.v.data();
  std::array<std::array<double, kLanes>, kSums> lanes{};
  for (std::size_t i = 0; i < system.x.size(); i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double w = weights[i + lane];
      const double px = x[i + lane], py = y[i + lane];
      const double pu = u[i + lane], pv = v[i + lane];
      // The two rows: (a, b, c) = (1 + x^2, x y, y), (x y, 1 + y^2, -x).
      const double a = 1 + px * px, b = px * py, d = 1 + py * py;
      lanes[kAA][lane] += w * (a * a + b * b);
      lanes[kAB][lane] += w * b * (a + d);
      lanes[kAC][lane] += w * (a * py - b * px);
      lanes[kBB][lane] += w * (b * b + d * d);
      lanes[kBC][lane] += w * (b * py - d * px);
      lanes[kCC][lane] += w * (py * py + px * px);
      lanes[kAF][lane] += w * (a * pu + b * pv);
      lanes[kBF][lane] += w * (b * pu + d * pv);
      lanes[kCF][lane] += w * (py * pu - px * pv);
    }
  }
  for (std::size_t sum = 0; sum < kSums; ++sum) {
    sums[sum] = (lanes[sum][0] + lanes[sum][1]) + (lanes[sum][2] + lanes[sum][3]);
  }
}

Rotation SolveWeighted(const System& system, const std::vector<double>& weights) {
  std::array<double, kSums> s;
  AddUp(system, weights.data(), s.data());
  Eigen::Matrix3d normal;
  normal << s[kAA], s[kAB], s[kAC], s[kAB], s[kBB], s[kBC], s[kAC], s[kBC], s[kCC];
  normal += kDamping * Eigen::Matrix3d::Identity();
  return normal.ldlt().solve(Eigen::Vector3d(s[kAF], s[kBF], s[kCF]));
}

// A rotation, its residuals, and the weights for the next iteration.
struct Fit {
  Rotation rotation;
  // One entry a vector.
  std::vector<float> squares;
  double median_square = 0;
  std::vector<double> weights;
};

void Weigh(const System& system, Fit& fit) {
  SquaredResiduals(system, fit.rotation, fit.squares.data());
  fit.median_square = Median(fit.squares);
  const double scale = 1.5 * std::sqrt(fit.median_square) + 1e-6 / system.focal;
  FadingWeights(fit.squares.data(), system.size, scale, fit.weights.data());
}

Fit SolveRobustly(const System& system) {
  Fit fit;
  fit.squares.resize(system.size);
  // As long as the columns.
  fit.weights.resize(system.x.size());
  fit.rotation = {system.median_u, system.median_v, 0};
  Weigh(system, fit);
  for (int i = 0; i < kMaxIterations; ++i) {
    const Rotation before = fit.rotation;
    fit.rotation = SolveWeighted(system, fit.weights);
    Weigh(system, fit);
    if ((fit.rotation - before).cwiseAbs().maxCoeff() * system.focal < kConvergedPx) {
      break;
    }
  }
  return fit;
}

// Weighted least squares on the vertical components alone.
void FitVertical(const System& system, const std::vector<double>& weights, RotationFit& fit) {
  // The sums of the normal equations are separate variables: a matrix would be written to memory
  // and read again for each vector, and the processor would wait for it.
  double aa = kDamping, bb = kDamping, cc = kDamping, ab = 0, ac = 0, bc = 0;
  double av = 0, bv = 0, cv = 0, squares = 0, sum = 0;
  for (std::size_t i = 0; i < system.size; ++i) {
    const double x = system.x[i], y = system.y[i], v = system.v[i];
    const double a = x * y, b = 1 + y * y, c = -x;
    const double wa = weights[i] * a, wb = weights[i] * b, wc = weights[i] * c;
    aa += wa * a;
    ab += wa * b;
    ac += wa * c;
    bb += wb * b;
    bc += wb * c;
    cc += wc * c;
    av += wa * v;
    bv += wb * v;
    cv += wc * v;
    squares += weights[i] * v * v;
    sum += weights[i];
  }
  Eigen::Matrix3d normal;
  normal << aa, ab, ac, ab, bb, bc, ac, bc, cc;
  const Eigen::Vector3d right(av, bv, cv);
  const Eigen::Matrix3d inverse = normal.inverse();
  const Eigen::Vector3d rotation = inverse * right;
  // Weighted sum of the squared residuals.
  const double left_over = std::max(0.0, squares - rotation.dot(right));
  fit.vertical_pan = rotation[0];
  fit.vertical_pan_error = std::sqrt(left_over / sum * inverse(0, 0));
}

HOMING_VECTOR_CLONES
std::size_t CountExplained(const System& system, const Rotation& rotation, const float* squares) {
  const double pan = rotation[0], tilt = rotation[1], roll = rotation[2];
  const double* const xs = system.x.data();
  const double* const ys = system.y.data();
  const double noise = kNoisePx / system.focal;
  std::int64_t explained = 0;
  for (std::size_t i = 0; i < system.size; ++i) {
    const double x = xs[i], y = ys[i];
    const double u = pan * (1 + x * x) + tilt * x * y + roll * y;
    const double v = pan * x * y + tilt * (1 + y * y) - roll * x;
    const double near = std::max(noise * noise, kNoiseShare * kNoiseShare * (u * u + v * v));
    explained += squares[i] <= near ? 1 : 0;
  }
  return static_cast<std::size_t>(explained);
}

}  // namespace

RotationFit FitRotation(const FlowField& field, const Camera& camera) {
  const System system(field, camera);
  const Fit solved = SolveRobustly(system);
  RotationFit fit;
  fit.pan = solved.rotation[0];
  const std::size_t explained = CountExplained(system, solved.rotation, solved.squares.data());
  fit.explained = static_cast<double>(explained) / static_cast<double>(system.size);
  if (2 * explained >= system.size) {
    FitVertical(system, solved.weights, fit);
  }
  fit.median_residual = system.focal * std::sqrt(solved.median_square);
  std::vector<float> lengths(system.size);
  FillLengths(field.vectors, lengths.data());
  fit.median_length = Median(lengths);
  return fit;
}

}  // namespace homing
