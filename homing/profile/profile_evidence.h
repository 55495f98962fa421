// What a distance between flow profiles says: the likelihood ratio of the very place against a
// place at random. Source: own design; fitted to matched and unmatched pairs (docs/algorithm.md).
#ifndef HOMING_PROFILE_PROFILE_EVIDENCE_H_
#define HOMING_PROFILE_PROFILE_EVIDENCE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace homing {

// The unmatched distances of what is seen now: poor light makes all of them great, so only how far
// one lies below the others tells anything.
struct DistanceScale {
  float middle = 0;
  // 1 / their deviation.
  float per_deviation = 0;

  float Deviations(std::uint16_t distance) const {
    return (static_cast<float>(distance) - middle) * per_deviation;
  }
};

// Of the distances to many steps of the journeys, most of them of other places. A short sample says
// little: then what is usual counts more.
DistanceScale ScaleOf(std::span<const std::uint16_t> sample);

// What a view of so many flow vectors may say, of kWholeWeight: few of them show little.
inline constexpr int kWholeWeight = 8;
int EvidenceWeight(std::size_t vectors);

// The ratio of a distance so many deviations from the middle of the unmatched ones. Positive.
class ProfileRatio {
 public:
  // Of the first observation of a robot, which depends on nothing before.
  static const ProfileRatio& First();
  // Of a further one, which shows nearly what the one before has shown: tempered.
  // `weight`: of EvidenceWeight.
  static const ProfileRatio& Further(int weight);

  float operator()(float deviations) const {
    return values_[static_cast<std::size_t>(IndexOf(deviations))];
  }

  // Multiplies each factor by the ratio of its distance. REQUIRES: both equally long.
  void Multiply(std::span<const std::uint16_t> distances, const DistanceScale& scale,
                std::span<float> factors) const;

 private:
  static constexpr float kMost = 16;
  static constexpr float kPerDeviation = 32;
  static constexpr auto kCount = static_cast<std::int32_t>(2 * kMost * kPerDeviation);

  explicit ProfileRatio(double temper);

  static std::int32_t IndexOf(float deviations) {
    const auto at = static_cast<std::int32_t>((deviations + kMost) * kPerDeviation);
    const std::int32_t least = at < 0 ? 0 : at;
    return least < kCount ? least : kCount - 1;
  }
  static void MultiplyEach(const float* __restrict values, std::span<const std::uint16_t> distances,
                           DistanceScale scale, float* __restrict factors);

  std::array<float, static_cast<std::size_t>(kCount)> values_;
};

}  // namespace homing

#endif  // HOMING_PROFILE_PROFILE_EVIDENCE_H_
