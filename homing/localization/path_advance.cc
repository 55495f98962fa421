#include <algorithm>
#include <cmath>
#include <vector>

#include "homing/localization/path_pose.h"

namespace homing {
namespace {

// Sharpest bend of a path, rad for a unit driven. Where the two sides disagree by more, an object
// has disappeared, and the earlier bend is forgotten.
constexpr double kMostBend = 0.3;
constexpr double kForgetBend = 0.9;
// Stored flow, rad, and steps below which a division says nothing; weight of the latest bend.
constexpr double kLeastStored = 0.004;
constexpr double kLeastSteps = 0.2;
constexpr double kFollow = 0.3;
// The path's bend is the median of the turns this many steps either way, of at least kLeastTurns.
constexpr std::int64_t kBendSteps = 4;
constexpr std::ptrdiff_t kLeastTurns = 5;

double Middle(double a, double b, double c) {
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

}  // namespace

std::optional<double> PathPoseFilter::StoredBend(const JourneyMap& map, std::int64_t step) {
  std::vector<double> turns;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const auto profiles = map.profiles(side);
    const auto count = static_cast<std::int64_t>(profiles.size());
    for (std::int64_t s = std::max<std::int64_t>(0, step - kBendSteps);
         s < std::min(count, step + kBendSteps + 1); ++s) {
      if (const auto turn = profiles[static_cast<std::size_t>(s)].odometer.turn()) {
        turns.push_back(*turn);
      }
    }
  }
  if (std::ssize(turns) < kLeastTurns) return std::nullopt;
  const auto middle = turns.begin() + std::ssize(turns) / 2;
  std::ranges::nth_element(turns, middle);
  return *middle;
}

// Without the turn, each side's flow is the stored flow, less the part of the path's own bend,
// times the steps advanced. Where a landmark was removed, one side gives a wrong number of steps,
// and the other one agrees with the number before: so the middle one of these three is taken. A
// bend counts only if both sides agree on it.
PathPoseFilter::Advance PathPoseFilter::AdvanceOf(const std::array<double, 2>& now,
                                                  const std::array<double, 2>& then, double turn,
                                                  std::optional<double> bend) {
  std::array<double, 2> moved{};
  for (const Side side : {Side::kLeft, Side::kRight}) {
    // Nearer objects move faster.
    const double left = travel_ == Travel::kReturn ? -pose_.offset : pose_.offset;
    const double nearer = side == Side::kLeft ? left : -left;
    moved[static_cast<std::size_t>(side)] =
        (now[static_cast<std::size_t>(side)] - turn) * (1 - nearer);
  }
  const double mean = (moved[1] - moved[0]) / (then[1] - then[0]);
  if (!advance_) advance_ = Advance{.steps = mean, .bend = 0};
  if (bend) advance_->bend = *bend;
  const auto steps_of = [&](std::size_t side) {
    const double stored = then[side] - advance_->bend;
    return std::abs(stored) > kLeastStored ? moved[side] / stored : mean;
  };
  Advance result;
  result.steps = Middle(steps_of(0), steps_of(1), advance_->steps);
  result.bend = kForgetBend * advance_->bend;
  if (bend) {
    result.bend = *bend;
  } else if (std::abs(result.steps) > kLeastSteps) {
    const double left = then[0] - moved[0] / result.steps;
    const double right = then[1] - moved[1] / result.steps;
    const double most = kMostBend * 0.5 * std::abs(then[1] - then[0]);
    if (std::abs(left - right) < most) {
      result.bend = std::clamp(0.5 * (left + right), -most, most);
    }
  }
  advance_->steps += kFollow * (result.steps - advance_->steps);
  advance_->bend += kFollow * (result.bend - advance_->bend);
  return result;
}

}  // namespace homing
