#include "homing/localization/speed_evidence.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "homing/profile/route_scale.h"

namespace homing {
namespace {

// Width of the ratio's distribution (Laplace): this many times its noise, at least kLeastWidth
// octaves. A fraction kOutlierFraction of the ratios is six times as wide.
constexpr double kWidthOfNoise = 4;
constexpr double kLeastWidth = 0.08;
constexpr double kOutlierFraction = 0.05;
constexpr double kOutlierWidth = 6;
// A speed stands for all within so many octaves: the speeds are half an octave apart. A ratio
// between two of them must not count less than one of a place where the robot would stand.
constexpr double kHalfSpacing = 0.25;
// A slower robot counts as standing, log2 of steps an observation.
constexpr double kStanding = -3.6;
// Noise at which the odometer counts half as good as it can be, octaves.
constexpr double kHalfNoise = 0.087;
// Consecutive ratios of a poor odometer err alike: exponent of what one says.
constexpr double kPoorWeight = 0.3;
// Probability an observation that the speed changes: with a poor odometer, and with a good one.
constexpr double kPoorChange = 0.05;
constexpr double kGoodChange = 0.3;

// `apart`: from the speed, octaves.
double Likelihood(double apart, double width) {
  const double error = std::max(0.0, std::abs(apart) - kHalfSpacing);
  return (1 - kOutlierFraction) * std::exp(-error / width) +
         kOutlierFraction * std::exp(-error / (kOutlierWidth * width));
}

}  // namespace

SpeedEvidence::SpeedEvidence(double noise) {
  const double good = 1 / (1 + std::pow(noise / kHalfNoise, 2));
  const double weight = kPoorWeight + (1 - kPoorWeight) * good;
  change_ = kPoorChange + (kGoodChange - kPoorChange) * good;
  const double width = std::max(kLeastWidth, kWidthOfNoise * noise);
  for (std::size_t speed = 0; speed < kSpeedCount; ++speed) {
    for (std::size_t index = 0; index < kNoRatio; ++index) {
      const double code = static_cast<double>(index) - kMostCode;
      const double ratio = code / CameraOdometer::kPerOctave;
      const double likelihood =
          speed == 0
              ? (1 - kOutlierFraction) * std::exp(-std::max(0.0, ratio - kStanding) / width) +
                    kOutlierFraction * kOutlierFraction
              : Likelihood(ratio - std::log2(kSpeeds[speed]), width);
      tables_[speed][index] = static_cast<float>(std::pow(likelihood, weight));
    }
    tables_[speed][kNoRatio] = 1;
  }
}

std::shared_ptr<const SpeedEvidence> SpeedEvidence::OfNoise(double noise) {
  static thread_local std::map<double, std::weak_ptr<const SpeedEvidence>> used;
  std::erase_if(used, [](const auto& entry) { return entry.second.expired(); });
  std::shared_ptr<const SpeedEvidence> shared = used[noise].lock();
  if (!shared) used[noise] = shared = std::make_shared<const SpeedEvidence>(noise);
  return shared;
}

}  // namespace homing
