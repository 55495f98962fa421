#include "homing/profile/profile_evidence.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "homing/base/vector_clones.h"
#include "homing/flow/median.h"

namespace homing {
namespace {

// A distance of u deviations speaks for the step as exp(kSlope (-u - kNeutral)), kMostEvidence at
// most; with probability kOutlierFraction the place does not look as it did (hidden, removed, new).
// docs/algorithm.md lists these constants and what each real set would choose.
constexpr double kSlope = 2;
constexpr double kNeutral = 1;
constexpr double kOutlierFraction = 0.25;
// Least deviation of a sample: distances that are all alike do not distinguish places.
constexpr double kLeastDeviation = 0.02;
constexpr int kWeights = 16;

// Number, sum and sum of squares of some distances.
struct Moments {
  std::uint64_t count = 0;
  std::uint64_t sum = 0;
  std::uint64_t squares = 0;
};

HOMING_VECTOR_CLONES
Moments MomentsAbove(std::span<const std::uint16_t> sample, std::uint32_t least) {
  Moments moments;
  for (const std::uint32_t distance : sample) {
    const std::uint32_t above = distance > least ? distance : 0;
    moments.count += above > 0 ? 1 : 0;
    moments.sum += above;
    moments.squares += std::uint64_t{above} * above;
  }
  return moments;
}

HOMING_VECTOR_CLONES
void MultiplyEach(const float* __restrict values, std::int32_t most, float per_unit, float first,
                  std::span<const std::uint16_t> distances, const std::int16_t* __restrict bias,
                  float* __restrict factors) {
  const std::uint16_t* const from = distances.data();
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const auto at = static_cast<std::int32_t>(
        static_cast<float>(std::int32_t{from[i]} - std::int32_t{bias[i]}) * per_unit + first);
    const std::int32_t least = at < 0 ? 0 : at;
    factors[i] *= values[least < most ? least : most];
  }
}

}  // namespace

// The lower half holds the true place: the deviation is that of the upper half.
DistanceScale ScaleOf(std::span<const std::uint16_t> sample) {
  if (sample.empty()) {
    return {};
  }
  const double middle = std::max<double>(1, Median(sample));
  const Moments above = MomentsAbove(sample, static_cast<std::uint32_t>(middle));
  const auto count = static_cast<double>(above.count);
  const double squares = static_cast<double>(above.squares) -
                         2 * middle * static_cast<double>(above.sum) + count * middle * middle;
  const double deviation =
      std::max(kLeastDeviation * middle, count > 0 ? std::sqrt(squares / count) : 0);
  return {static_cast<float>(middle), static_cast<float>(1 / deviation)};
}

ProfileRatio::ProfileRatio(double weight) {
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const double u = (static_cast<double>(i) + 0.5) / kPerDeviation - kMost;
    const double evidence = std::min(kSlope * (-u - kNeutral), kMostEvidence);
    values_[i] = static_cast<float>(
        std::pow(kOutlierFraction + (1 - kOutlierFraction) * std::exp(evidence), weight));
  }
}

void ProfileRatio::Multiply(std::span<const std::uint16_t> distances,
                            std::span<const std::int16_t> bias, const DistanceScale& scale,
                            std::span<float> factors) const {
  MultiplyEach(values_.data(), kCount - 1, scale.per_deviation * kPerDeviation,
               (kMost - scale.middle * scale.per_deviation) * kPerDeviation, distances, bias.data(),
               factors.data());
}

const ProfileRatio& ProfileRatio::OfWeight(double weight) {
  static const auto ratios = [] {
    std::vector<ProfileRatio> all;
    all.reserve(kWeights);
    for (int i = 0; i < kWeights; ++i) {
      all.push_back(ProfileRatio(std::pow(2, -0.5 * i)));
    }
    return all;
  }();
  const double halvings = weight > 0 ? -2 * std::log2(weight) : kWeights;
  const auto index = static_cast<std::size_t>(
      std::clamp(std::lround(halvings), 0L, static_cast<long>(kWeights - 1)));
  return ratios[index];
}

}  // namespace homing
