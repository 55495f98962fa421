#include "client/simulator/speed_profile.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "client/simulator/geometry.h"
#include "client/simulator/seeded_random.h"

namespace homing::client {
namespace {

constexpr double kSpacingM = 0.02;
// Approximate distance from one slowest place to the next.
constexpr double kPeriodM = 9;
constexpr double kUnevenPeriodM = 23;
constexpr double kUnevenRad = 2;

}  // namespace

SpeedProfile::SpeedProfile(double length_m, double speed_m_s, double vary, std::uint64_t seed)
    : length_m_(length_m), speed_m_s_(speed_m_s), vary_(vary) {
  if (vary == 0) {
    return;
  }
  SeededRandom random(Mix(seed, 79));
  slow_phase_ = random.Uniform(0, kTurn);
  quick_phase_ = random.Uniform(0, kTurn);
  times_s_.push_back(0);
  for (double at_m = 0; at_m < length_m; at_m += kSpacingM) {
    times_s_.push_back(times_s_.back() + kSpacingM / SpeedAt(at_m + 0.5 * kSpacingM));
  }
}

double SpeedProfile::SpeedAt(double driven_m) const {
  const double uneven = kUnevenRad * std::sin(kTurn * driven_m / kUnevenPeriodM + slow_phase_);
  const double wave = std::sin(kTurn * driven_m / kPeriodM + quick_phase_ + uneven);
  const double low = std::log(kSlowest);
  const double high = std::log(kFastest);
  return speed_m_s_ * std::exp(vary_ * (0.5 * (low + high) + 0.5 * (high - low) * wave));
}

double SpeedProfile::TimeS(double driven_m) const {
  if (times_s_.empty()) {
    return driven_m / speed_m_s_;
  }
  const double place =
      std::clamp(driven_m / kSpacingM, 0.0, static_cast<double>(times_s_.size()) - 1);
  const auto below = std::min(static_cast<std::size_t>(place), times_s_.size() - 2);
  const double share = place - static_cast<double>(below);
  return times_s_[below] + share * (times_s_[below + 1] - times_s_[below]);
}

double SpeedProfile::DrivenMetres(double time_s) const {
  if (times_s_.empty()) {
    return std::clamp(time_s * speed_m_s_, 0.0, length_m_);
  }
  const auto above = std::clamp<std::ptrdiff_t>(
      std::ranges::upper_bound(times_s_, time_s) - times_s_.begin(), 1, std::ssize(times_s_) - 1);
  const auto at = static_cast<std::size_t>(above);
  const double share = (time_s - times_s_[at - 1]) / (times_s_[at] - times_s_[at - 1]);
  return std::clamp((static_cast<double>(above) - 1 + share) * kSpacingM, 0.0, length_m_);
}

}  // namespace homing::client
