#include "homing/localization/profile_evidence.h"

#include <cmath>
#include <vector>

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

}  // namespace

// The lower half holds the matched ones: the deviation is that of the upper half.
DistanceScale ScaleOf(std::span<std::uint16_t> sample) {
  double middle = kMiddle;
  if (!sample.empty()) {
    const auto half = sample.begin() + static_cast<std::ptrdiff_t>(sample.size() / 2);
    std::nth_element(sample.begin(), half, sample.end());
    const auto count = static_cast<double>(sample.size());
    middle = (count * static_cast<double>(*half) + kMiddleWorth * kMiddle) / (count + kMiddleWorth);
  }
  double squares = kDeviationWorth * kDeviation * kDeviation;
  double above = kDeviationWorth;
  for (const std::uint16_t distance : sample) {
    const double relative = static_cast<double>(distance) / middle - 1;
    if (relative > 0) {
      squares += relative * relative;
      above += 1;
    }
  }
  const double deviation = middle * std::sqrt(squares / above);
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
