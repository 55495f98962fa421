#include "homing/landmark/flow_profile.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>
#include <span>

#include "absl/container/fixed_array.h"
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
};

class CellAdder {
 public:
  // `x`, `y` in 0..1 of the image; `value`: log2 of the flow.
  void Add(float x, float y, float value) {
    // Both are at least -0.5, so that the cast rounds down.
    const float column = x * kColumns + 0.5F;
    const float row = y * kRows + 0.5F;
    const auto left = static_cast<std::uint32_t>(column);
    const auto top = static_cast<std::uint32_t>(row);
    const float right = column - static_cast<float>(left);
    const float bottom = row - static_cast<float>(top);
    const Four across = {1 - right, (1 - right) * value, right, right * value};
    float* const above = &sums_[std::size_t{2} * (top * kWidth + left)];
    AddTo(above, (1 - bottom) * across);
    AddTo(above + std::size_t{2} * kWidth, bottom * across);
    vectors_ += 1;
    all_log_flow_ += value;
  }
  // The sums of each cell. Vectors outside the outermost cells' middles count in these cells alone.
  CellSums Sums() const {
    CellSums result;
    for (int row = 0; row < kRows + 2; ++row) {
      for (int column = 0; column < kColumns + 2; ++column) {
        const auto from = std::size_t{2} * (static_cast<std::uint32_t>(row) * kWidth +
                                            static_cast<std::uint32_t>(column));
        const auto to = static_cast<std::size_t>(std::clamp(row - 1, 0, kRows - 1) * kColumns +
                                                 std::clamp(column - 1, 0, kColumns - 1));
        result.weight[to] += sums_[from];
        result.log_flow[to] += sums_[from + 1];
      }
    }
    return result;
  }
  float vectors() const { return vectors_; }
  float all_log_flow() const { return all_log_flow_; }

 private:
  // Two neighbouring cells, of each its weight and its log flow.
  using Four __attribute__((vector_size(16))) = float;
  // With a margin of one cell around the image.
  static constexpr std::uint32_t kWidth = kColumns + 2;

  static void AddTo(float* sums, Four more) {
    Four four;
    std::memcpy(&four, sums, sizeof(four));
    four += more;
    std::memcpy(sums, &four, sizeof(four));
  }

  std::array<float, std::size_t{2} * kWidth*(kRows + 2)> sums_{};
  float vectors_ = 0;
  float all_log_flow_ = 0;
};

// Factors that convert the sums to codes.
struct CodeScale {
  // Part of the vectors for a unit of weight.
  float per_weight = 1;
  float mean_log_flow = 0;
};

HOMING_VECTOR_CLONES
void CodesOf(const CellSums& sums, const CodeScale& scale, std::uint8_t* __restrict cells) {
  constexpr float kMost = FlowProfile::kMaxCode;
  std::array<std::int32_t, FlowProfile::kCells> counts{};
  for (std::size_t cell = 0; cell < counts.size(); ++cell) {
    const float root = std::sqrt(sums.weight[cell] * scale.per_weight);
    const float code = static_cast<float>(FlowProfile::kCountPerRoot) * root + 0.5F;
    counts[cell] = static_cast<std::int32_t>(code < kMost ? code : kMost);
  }
  std::array<std::int32_t, FlowProfile::kCells / 2> parallaxes{};
  for (std::size_t pair = 0; pair < parallaxes.size(); ++pair) {
    const float weight = sums.weight[2 * pair] + sums.weight[2 * pair + 1];
    const float log_sum = sums.log_flow[2 * pair] + sums.log_flow[2 * pair + 1];
    const float octaves =
        log_sum / (weight > kLeastWeight ? weight : kLeastWeight) - scale.mean_log_flow;
    const float code =
        FlowProfile::kMeanParallax + FlowProfile::kParallaxPerOctave * octaves + 0.5F;
    const float least = code > 1 ? code : 1;
    const auto clamped = static_cast<std::int32_t>(least < kMost ? least : kMost);
    parallaxes[pair] = weight > kLeastWeight ? clamped : 0;
  }
  for (std::size_t cell = 0; cell < counts.size(); ++cell) {
    cells[cell] = static_cast<std::uint8_t>(parallaxes[cell / 2] << 4 | counts[cell]);
  }
}

// By vector.
struct Columns {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* log_flow = nullptr;
};

// Up to this many vectors need no memory from the heap.
constexpr std::size_t kUsual = 512;
using Column = absl::FixedArray<float, kUsual>;

// Midpoints from the middle of the image, in image sizes, and log2 of the lengths.
HOMING_VECTOR_CLONES
void FillColumns(const FlowField& field, float* __restrict x, float* __restrict y,
                 float* __restrict log_flow) {
  const FlowVector* const from = field.vectors.data();
  const double middle_x = 0.5 * (field.width - 1), middle_y = 0.5 * (field.height - 1);
  const double width = field.width, height = field.height;
  for (std::size_t i = 0; i < field.vectors.size(); ++i) {
    const double length = from[i].Length();
    x[i] = static_cast<float>((from[i].MidX() - middle_x) / width);
    y[i] = static_cast<float>((from[i].MidY() - middle_y) / height);
    log_flow[i] = Log2(static_cast<float>(length > kLeastFlowPx ? length : kLeastFlowPx));
  }
}

bool IsFinite(const FlowVector& v) { return v.Length() <= std::numeric_limits<float>::max(); }

// The midpoints of the vectors in the magnified image, and their lengths there.
struct MagnifiedView {
  float magnification = 1;
  float mean_log_flow = 0;
};
HOMING_VECTOR_CLONES
void Magnify(const MagnifiedView& view, std::size_t size, const Columns& from, float* __restrict x,
             float* __restrict y, float* __restrict log_flow) {
  const float scale = 1 - view.magnification;
  for (std::size_t i = 0; i < size; ++i) {
    // Nearness of the object to the path, relative to an object with the mean flow. Three terms of
    // 2^d are exact enough for a factor that is clamped.
    const float d = from.log_flow[i] - view.mean_log_flow;
    const float e = d * 0.6931472F * 0.25F;
    const float quarter = 1 + e * (1 + e * (0.5F + e * 0.1666667F));
    const float half = quarter * quarter;
    const float near = half * half;
    const float depth = view.magnification + near * scale;
    const float larger = view.magnification / (depth > kLeastDepth ? depth : kLeastDepth);
    x[i] = from.x[i] * larger;
    y[i] = from.y[i] * larger;
    log_flow[i] = from.log_flow[i] + Log2(larger);
  }
}

}  // namespace

ProfileMaker::ProfileMaker(const FlowField& field) : ProfileMaker(field, ReadOdometer(field)) {}

ProfileMaker::ProfileMaker(const FlowField& field, const OdometerReading& odometer)
    : odometer_(odometer) {
  for (auto* of : {&x_, &y_, &log_flow_}) of->resize(field.vectors.size());
  FillColumns(field, x_.data(), y_.data(), log_flow_.data());
  if (!std::ranges::all_of(field.vectors, IsFinite)) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < field.vectors.size(); ++i) {
      if (!IsFinite(field.vectors[i])) continue;
      for (auto* of : {&x_, &y_, &log_flow_}) (*of)[kept] = (*of)[i];
      ++kept;
    }
    for (auto* of : {&x_, &y_, &log_flow_}) of->resize(kept);
  }
  const float sum = std::accumulate(log_flow_.begin(), log_flow_.end(), 0.0F);
  mean_log_flow_ = x_.empty() ? 0 : sum / static_cast<float>(x_.size());
}

FlowProfile ProfileMaker::Make(double magnification, double shift) const {
  CellAdder sums;
  const float middle_x = 0.5F + static_cast<float>(shift);
  const auto add = [&](std::span<const float> x, std::span<const float> y,
                       std::span<const float> log_flow) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const float at_x = x[i] + middle_x, at_y = y[i] + 0.5F;
      if (at_x >= 0 && at_x < 1 && at_y >= 0 && at_y < 1) sums.Add(at_x, at_y, log_flow[i]);
    }
  };
  if (magnification == 1) {
    add(x_, y_, log_flow_);
  } else {
    Column x(x_.size()), y(x_.size()), log_flow(x_.size());
    Magnify({static_cast<float>(magnification), mean_log_flow_}, x.size(),
            {x_.data(), y_.data(), log_flow_.data()}, x.data(), y.data(), log_flow.data());
    add(x, y, log_flow);
  }
  FlowProfile profile;
  if (sums.vectors() == 0) {
    return profile;
  }
  profile.odometer = odometer_;
  // Fraction of the changed image that this image fills.
  const auto filled =
      static_cast<float>(std::min(1.0, magnification * magnification) * (1 - std::abs(shift)));
  const CodeScale scale = {
      filled / std::sqrt(sums.vectors() * static_cast<float>(FlowProfile::kUsualCount)),
      sums.all_log_flow() / sums.vectors()};
  CodesOf(sums.Sums(), scale, profile.cells.data());
  return profile;
}

}  // namespace homing
