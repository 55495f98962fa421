#include "homing/profile/profile_evidence.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "homing/base/vector_clones.h"
#include "homing/flow/median.h"

namespace homing {
namespace {

// Fitted: a distance of u deviations from the middle of the unmatched ones speaks for the step as
// exp(kSlope (-u - kNeutral)), kMostEvidence at most, and comes from anywhere (hidden, removed,
// new) with probability kOutlierShare.
constexpr double kSlope = 2;
constexpr double kNeutral = 1;
constexpr double kMostEvidence = 5;
constexpr double kOutlierShare = 0.25;
// Exponent of what a further observation of kEnoughVectors or more says.
constexpr double kTemper = 0.3;
constexpr double kEnoughVectors = 50;
// Deviation of unmatched distances, of their middle, and how many of them it is worth.
constexpr double kDeviation = 0.17;
constexpr double kDeviationWorth = 100;
constexpr double kMiddle = 600;
constexpr double kMiddleWorth = 2;

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

}  // namespace

// The lower half holds the matched ones: the deviation is that of the upper half.
DistanceScale ScaleOf(std::span<const std::uint16_t> sample) {
  double middle = kMiddle;
  if (!sample.empty()) {
    const double median = Median(sample);
    const auto count = static_cast<double>(sample.size());
    middle = (count * median + kMiddleWorth * kMiddle) / (count + kMiddleWorth);
  }
  // Of the sum of (distance / middle - 1)^2.
  const Moments above = MomentsAbove(sample, static_cast<std::uint32_t>(middle));
  const auto count = static_cast<double>(above.count);
  const double squares = static_cast<double>(above.squares) / (middle * middle) -
                         2 * static_cast<double>(above.sum) / middle + count;
  const double variance =
      (kDeviationWorth * kDeviation * kDeviation + squares) / (kDeviationWorth + count);
  const double deviation = middle * std::sqrt(variance);
  return {static_cast<float>(middle), static_cast<float>(1 / deviation)};
}

ProfileRatio::ProfileRatio(double temper) {
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const double u = (static_cast<double>(i) + 0.5) / kPerDeviation - kMost;
    const double evidence = std::min(kSlope * (-u - kNeutral), kMostEvidence);
    values_[i] = static_cast<float>(
        std::pow(kOutlierShare + (1 - kOutlierShare) * std::exp(evidence), temper));
  }
}

HOMING_VECTOR_CLONES
void ProfileRatio::MultiplyEach(const float* __restrict values,
                                std::span<const std::uint16_t> distances, DistanceScale scale,
                                float* __restrict factors) {
  const std::uint16_t* const from = distances.data();
  for (std::size_t i = 0; i < distances.size(); ++i) {
    factors[i] *= values[IndexOf(scale.Deviations(from[i]))];
  }
}

void ProfileRatio::Multiply(std::span<const std::uint16_t> distances, const DistanceScale& scale,
                            std::span<float> factors) const {
  MultiplyEach(values_.data(), distances, scale, factors.data());
}

const ProfileRatio& ProfileRatio::First() {
  static const ProfileRatio ratio(1);
  return ratio;
}

const ProfileRatio& ProfileRatio::Further(int weight) {
  static const auto ratios = [] {
    std::vector<ProfileRatio> all;
    for (int i = 0; i <= kWholeWeight; ++i) {
      all.push_back(ProfileRatio(kTemper * i / kWholeWeight));
    }
    return all;
  }();
  return ratios[static_cast<std::size_t>(weight)];
}

int EvidenceWeight(std::size_t vectors) {
  const double share = std::min(1.0, static_cast<double>(vectors) / kEnoughVectors);
  // Few vectors are also much the same ones in view after view: the square of their share.
  return std::max(1, static_cast<int>(std::lround(kWholeWeight * share * share)));
}

}  // namespace homing
