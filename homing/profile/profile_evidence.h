// Converts a distance between flow profiles to the likelihood ratio of the true place against a
// place at random.
#ifndef HOMING_PROFILE_PROFILE_EVIDENCE_H_
#define HOMING_PROFILE_PROFILE_EVIDENCE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace homing {

// Distances to different places, for one observation. Poor light makes all distances large, so only
// the deviation from the others counts.
struct DistanceScale {
  float middle = 0;
  // 1 / their deviation.
  float per_deviation = 0;

  float Deviations(std::uint16_t distance) const {
    return (static_cast<float>(distance) - middle) * per_deviation;
  }
};

// The scale of distances to many steps of the journeys, most of which are different places.
DistanceScale ScaleOf(std::span<const std::uint16_t> sample);

// A table: the likelihood ratio, to the power of `weight`, by distance from the middle in
// deviations. Positive. Immutable.
class ProfileRatio {
 public:
  // Logarithm of the greatest ratio of full weight.
  static constexpr double kMostEvidence = 5;

  // The table of the weight nearest to `weight`: powers of the square root of 2 up to
  // 1. Observations that show nearly what the ones before have shown weigh less.
  static const ProfileRatio& OfWeight(double weight);

  float operator()(float deviations) const {
    return values_[static_cast<std::size_t>(IndexOf(deviations))];
  }

  // Multiplies each factor by the ratio of its distance less its bias. REQUIRES: equally long.
  void Multiply(std::span<const std::uint16_t> distances, std::span<const std::int16_t> bias,
                const DistanceScale& scale, std::span<float> factors) const;

 private:
  static constexpr float kMost = 16;
  static constexpr float kPerDeviation = 32;
  static constexpr auto kCount = static_cast<std::int32_t>(2 * kMost * kPerDeviation);

  explicit ProfileRatio(double weight);

  static std::int32_t IndexOf(float deviations) {
    const auto at = static_cast<std::int32_t>((deviations + kMost) * kPerDeviation);
    const std::int32_t least = at < 0 ? 0 : at;
    return least < kCount ? least : kCount - 1;
  }

  std::array<float, static_cast<std::size_t>(kCount)> values_;
};

}  // namespace homing

#endif  // HOMING_PROFILE_PROFILE_EVIDENCE_H_
