#include "homing/landmark/flow_profile.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "homing/base/vector_clones.h"

namespace homing {
namespace {

// Shorter flow is noise and counts as this long. Pixels.
constexpr double kLeastFlowPx = 0.05;
// No object is taken to be nearer to the camera than this, in distances of the mean flow.
constexpr float kLeastDepth = 0.3F;
// Least weight of the vectors in two cells for a parallax code.
constexpr float kLeastWeight = 0.25F;

constexpr int kColumns = FlowProfile::kColumns;
constexpr int kRows = FlowProfile::kRows;

// log2 of a positive normal number, within 1e-5. Only additions and multiplications, so that a
// loop over vectors is vectorised and every machine gives the same value.
inline float Log2(float value) {
  const auto bits = std::bit_cast<std::int32_t>(value);
  // The mantissa as a number from sqrt(1/2) to sqrt(2).
  const std::int32_t offset = bits - 0x3f3504f3;
  const auto exponent = static_cast<float>(offset >> 23);
  const float m = std::bit_cast<float>((offset & 0x007fffff) + 0x3f3504f3) - 1;
  // Chebyshev fit of log2(1 + m) / m.
  const float series =
      1.442699F +
      m * (-0.7212367F + m * (0.4800737F + m * (-0.3659299F + m * (0.3147088F - m * 0.2043859F))));
  return exponent + m * series;
}

// Sums over the vectors around each cell, bilinear weights.
struct CellSums {
  std::array<float, FlowProfile::kCells> weight{};
  // Sums of weight times log2 of the flow.
  std::array<float, FlowProfile::kCells> log_flow{};
  float vectors = 0;
  float all_log_flow = 0;

  // `x`, `y` in 0..1 of the image.
  void Add(float x, float y, float value) {
    const float column = x * kColumns - 0.5F;
    const float row = y * kRows - 0.5F;
    const float left = std::floor(column);
    const float top = std::floor(row);
    const float right_weight = column - left;
    const float bottom_weight = row - top;
    const int first = static_cast<int>(left);
    const int above = static_cast<int>(top);
    const auto cell_of = [](int r, int c) {
      return static_cast<std::size_t>(std::clamp(r, 0, kRows - 1) * kColumns +
                                      std::clamp(c, 0, kColumns - 1));
    };
    const auto add = [&](std::size_t cell, float w) {
      weight[cell] += w;
      log_flow[cell] += w * value;
    };
    add(cell_of(above, first), (1 - right_weight) * (1 - bottom_weight));
    add(cell_of(above, first + 1), right_weight * (1 - bottom_weight));
    add(cell_of(above + 1, first), (1 - right_weight) * bottom_weight);
    add(cell_of(above + 1, first + 1), right_weight * bottom_weight);
    vectors += 1;
    all_log_flow += value;
  }
};

std::uint8_t CountCode(float fraction) {
  const float code =
      std::round(static_cast<float>(FlowProfile::kCountPerRoot) * std::sqrt(fraction));
  return static_cast<std::uint8_t>(std::min(code, static_cast<float>(FlowProfile::kMaxCode)));
}

std::uint8_t ParallaxCode(float octaves) {
  const float code =
      FlowProfile::kMeanParallax + std::round(FlowProfile::kParallaxPerOctave * octaves);
  return static_cast<std::uint8_t>(
      std::clamp(code, 1.0F, static_cast<float>(FlowProfile::kMaxCode)));
}

// The midpoints of the vectors in the magnified image, and their lengths there.
struct MagnifiedView {
  float magnification = 1;
  float mean_log_flow = 0;
};
HOMING_VECTOR_CLONES
void Magnify(const MagnifiedView& view, std::size_t size, float* __restrict x, float* __restrict y,
             float* __restrict log_flow) {
  const float scale = 1 - view.magnification;
  for (std::size_t i = 0; i < size; ++i) {
    // Nearness of the object to the path, relative to an object with the mean flow. Three terms of
    // 2^d are exact enough for a factor that is clamped.
    const float d = log_flow[i] - view.mean_log_flow;
    const float e = d * 0.6931472F * 0.25F;
    const float quarter = 1 + e * (1 + e * (0.5F + e * 0.1666667F));
    const float half = quarter * quarter;
    const float near = half * half;
    const float depth = view.magnification + near * scale;
    const float larger = view.magnification / (depth > kLeastDepth ? depth : kLeastDepth);
    x[i] = x[i] * larger;
    y[i] = y[i] * larger;
    log_flow[i] = log_flow[i] + Log2(larger);
  }
}

}  // namespace

ProfileMaker::ProfileMaker(const FlowField& field) : odometer_(ReadOdometer(field)) {
  const double middle_x = 0.5 * (field.width - 1), middle_y = 0.5 * (field.height - 1);
  for (auto* of : {&x_, &y_, &log_flow_}) of->reserve(field.vectors.size());
  float sum = 0;
  for (const FlowVector& v : field.vectors) {
    const double length = v.Length();
    if (!(length <= std::numeric_limits<float>::max())) continue;
    x_.push_back(static_cast<float>((v.MidX() - middle_x) / field.width));
    y_.push_back(static_cast<float>((v.MidY() - middle_y) / field.height));
    log_flow_.push_back(Log2(static_cast<float>(std::max(length, kLeastFlowPx))));
    sum += log_flow_.back();
  }
  mean_log_flow_ = x_.empty() ? 0 : sum / static_cast<float>(x_.size());
}

FlowProfile ProfileMaker::Make(double magnification) const {
  std::vector<float> x = x_, y = y_, log_flow = log_flow_;
  if (magnification != 1) {
    Magnify({static_cast<float>(magnification), mean_log_flow_}, x.size(), x.data(), y.data(),
            log_flow.data());
  }
  CellSums sums;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const float at_x = x[i] + 0.5F, at_y = y[i] + 0.5F;
    if (at_x >= 0 && at_x < 1 && at_y >= 0 && at_y < 1) sums.Add(at_x, at_y, log_flow[i]);
  }
  FlowProfile profile;
  if (sums.vectors == 0) {
    return profile;
  }
  profile.odometer = odometer_;
  const float mean = sums.all_log_flow / sums.vectors;
  // Part of this image that the magnified one fills.
  const auto filled = static_cast<float>(std::min(1.0, magnification * magnification));
  const float per_vector =
      filled / std::sqrt(sums.vectors * static_cast<float>(FlowProfile::kUsualCount));
  for (std::size_t cell = 0; cell < FlowProfile::kCells; cell += 2) {
    const float weight = sums.weight[cell] + sums.weight[cell + 1];
    const float log_sum = sums.log_flow[cell] + sums.log_flow[cell + 1];
    const int parallax = weight > kLeastWeight ? ParallaxCode(log_sum / weight - mean) : 0;
    for (const std::size_t at : {cell, cell + 1}) {
      profile.cells[at] =
          static_cast<std::uint8_t>(parallax << 4 | CountCode(sums.weight[at] * per_vector));
    }
  }
  return profile;
}

}  // namespace homing
