// The odometer's evidence of the robot's speed: the ratio of the present flow to the flow stored at
// a step is the number of steps that the robot advances, if it is at that step.
#ifndef HOMING_LOCALIZATION_SPEED_EVIDENCE_H_
#define HOMING_LOCALIZATION_SPEED_EVIDENCE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace homing {

// Speeds of the filter, steps an observation: standing, then powers of the square root of 2.
inline constexpr std::array<double, 14> kSpeeds = {
    0, 0.125, 0.176777, 0.25, 0.353553, 0.5, 0.707107, 1, 1.414214, 2, 2.828427, 4, 5.656854, 8};
inline constexpr std::size_t kSpeedCount = kSpeeds.size();

// Likelihood of a measured ratio for each speed. Immutable.
class SpeedEvidence {
 public:
  // Codes of a ratio: 1/20 octave, at most this either way. kNoRatio is neutral to all speeds.
  static constexpr int kMostCode = 200;
  static constexpr std::int16_t kNoRatio = 2 * kMostCode + 1;

  // `noise`: deviation of log2 of the ratio, octaves.
  explicit SpeedEvidence(double noise);
  // The same, shared by the robots of a thread whose maps have this noise: the tables take 22 KB.
  static std::shared_ptr<const SpeedEvidence> OfNoise(double noise);

  // Index of a difference of two odometer readings.
  static std::int16_t IndexOf(int difference) {
    const int most = difference < kMostCode ? difference : kMostCode;
    return static_cast<std::int16_t>((most > -kMostCode ? most : -kMostCode) + kMostCode);
  }
  // Likelihood of the ratio by index, for one speed. Positive.
  const float* of(std::size_t speed) const { return tables_[speed].data(); }

  // Probability an observation that the speed changes. A good odometer is followed at once; a poor
  // one is averaged by the inertia of the speed.
  double change() const { return change_; }

 private:
  std::array<std::array<float, kNoRatio + 1>, kSpeedCount> tables_;
  double change_ = 0;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_SPEED_EVIDENCE_H_
