#include "homing/flow/vertical_turn.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <vector>

#include "homing/base/vector_clones.h"
#include "homing/flow/motion.h"

namespace homing {
namespace {

// Noise of the vertical flow, pixels: in the first pass, and at least.
constexpr double kFirstNoisePx = 1.0;
constexpr double kLeastNoisePx = 0.1;
// A little damping keeps the system solvable with few vectors.
constexpr double kRowDamping = 1e-9;

// Sums are added in this many lanes, so that they are bit-identical on every machine.
constexpr std::size_t kRowLanes = 4;
// A vertical flow that no fit explains, focal lengths.
constexpr double kNoFlow = 1e30;

// Vertical flow is v = turn a + tilt b + roll c, with a = x y, b = 1 + y^2, c = -x, in focal
// lengths. By vector, padded to whole lanes with flow that no fit explains.
struct Rows {
  Rows(const FlowField& field, const Camera& camera, double focal);

  std::vector<double> a, b, c, v;
};

HOMING_VECTOR_CLONES
void FillRows(std::span<const FlowVector> vectors, double center_x, double center_y,
              double per_focal, double* __restrict a, double* __restrict b, double* __restrict c,
              double* __restrict v) {
  const FlowVector* const from = vectors.data();
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    const double x = (from[i].MidX() - center_x) * per_focal;
    const double y = (from[i].MidY() - center_y) * per_focal;
    a[i] = x * y;
    b[i] = 1 + y * y;
    c[i] = -x;
    v[i] = from[i].FlowY() * per_focal;
  }
}

Rows::Rows(const FlowField& field, const Camera& camera, double focal) {
  const auto& in = camera.intrinsics;
  const double center_x = in ? in->center_x : 0.5 * (field.width - 1);
  const double center_y = in ? in->center_y : 0.5 * (field.height - 1);
  const std::size_t padded = (field.vectors.size() + kRowLanes - 1) / kRowLanes * kRowLanes;
  for (std::vector<double>* const column : {&a, &b, &c}) column->resize(padded);
  v.resize(padded, kNoFlow);
  FillRows(field.vectors, center_x, center_y, 1 / focal, a.data(), b.data(), c.data(), v.data());
}

// Indices of the sums of the normal equations.
enum RowSum {
  kRowAA,
  kRowAB,
  kRowAC,
  kRowBB,
  kRowBC,
  kRowCC,
  kRowAV,
  kRowBV,
  kRowCV,
  kRowSquares,
  kRowsUsed,
  kRowSums
};
using RowSums = std::array<double, kRowSums>;

// Sums over the vectors that a fit explains within `most`.
HOMING_VECTOR_CLONES
void AddRows(const Rows& rows, const double* fit, double most, double* sums) {
  using Four __attribute__((vector_size(kRowLanes * sizeof(double)))) = double;
  const double turn = fit[0], tilt = fit[1], roll = fit[2];
  std::array<Four, kRowSums> lanes{};
  for (std::size_t i = 0; i < rows.a.size(); i += kRowLanes) {
    Four a, b, c, v;
    std::memcpy(&a, &rows.a[i], sizeof(a));
    std::memcpy(&b, &rows.b[i], sizeof(b));
    std::memcpy(&c, &rows.c[i], sizeof(c));
    std::memcpy(&v, &rows.v[i], sizeof(v));
    const Four miss = v - (a * turn + b * tilt + c * roll);
    const auto within = (miss < most) & (-miss < most);
    const Four counts = within ? Four{1, 1, 1, 1} : Four{};
    const Four counted_a = a * counts, counted_b = b * counts, counted_c = c * counts;
    lanes[kRowAA] += counted_a * a;
    lanes[kRowAB] += counted_a * b;
    lanes[kRowAC] += counted_a * c;
    lanes[kRowBB] += counted_b * b;
    lanes[kRowBC] += counted_b * c;
    lanes[kRowCC] += counted_c * c;
    lanes[kRowAV] += counted_a * v;
    lanes[kRowBV] += counted_b * v;
    lanes[kRowCV] += counted_c * v;
    lanes[kRowSquares] += counts * miss * miss;
    lanes[kRowsUsed] += counts;
  }
  for (std::size_t sum = 0; sum < kRowSums; ++sum) {
    sums[sum] = (lanes[sum][0] + lanes[sum][1]) + (lanes[sum][2] + lanes[sum][3]);
  }
}

}  // namespace

// Fits the rows; then again without the vectors that lie more than three deviations off.
VerticalTurn ReadVerticalTurn(const FlowField& field, const Camera& camera) {
  const double focal = camera.intrinsics ? camera.intrinsics->focal_x : UsualFocal(field.width);
  const Rows rows(field, camera, focal);
  Eigen::Vector3d fit = Eigen::Vector3d::Zero();
  double noise = kFirstNoisePx / focal;
  for (int pass = 0; pass < 3; ++pass) {
    RowSums s;
    AddRows(rows, fit.data(), 3 * noise, s.data());
    if (s[kRowsUsed] < kMinVectors) return {};
    Eigen::Matrix3d normal;
    normal << s[kRowAA], s[kRowAB], s[kRowAC], s[kRowAB], s[kRowBB], s[kRowBC], s[kRowAC],
        s[kRowBC], s[kRowCC];
    normal += kRowDamping * Eigen::Matrix3d::Identity();
    const Eigen::LDLT<Eigen::Matrix3d> factors(normal);
    fit = factors.solve(Eigen::Vector3d(s[kRowAV], s[kRowBV], s[kRowCV]));
    if (pass > 0) noise = std::max(kLeastNoisePx / focal, std::sqrt(s[kRowSquares] / s[kRowsUsed]));
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
