// PositionFilter's answer from its belief; position_filter.cc updates the belief.
#include <algorithm>
#include <array>

#include "homing/localization/position_filter.h"

namespace homing {
namespace {

// Fraction of the moving mass that one direction must have to be reported.
constexpr double kDirectionMargin = 0.6;

// Steps count from home.
Direction DirectionOf(const std::array<double, 2>& mass) {
  const double both = mass[0] + mass[1];
  if (mass[0] > kDirectionMargin * both) {
    return Direction::kHomeward;
  }
  return mass[1] > kDirectionMargin * both ? Direction::kOutward : Direction::kUnknown;
}

}  // namespace

PositionFilter::Best PositionFilter::FindBest(std::int64_t half) const {
  Best best;
  for (std::size_t i = 0; i < beliefs_.size(); ++i) {
    const StepWindow window = BestWindow(masses_[i], half, beliefs_[i].step_count());
    if (window.mass > best.window.mass) {
      best = {i, window};
    }
  }
  return best;
}

Position PositionFilter::Answer() const {
  Position position;
  position.unknown_probability = 1 - membership_.OnRoute();
  if (!started_) {
    return position;
  }
  if (position.unknown_probability >= options_.unknown_probability) {
    position.outcome = Outcome::kUnknownPlace;
    return position;
  }
  position.speed_ratio = speed_.outward;
  if (has_offset_) position.path_offset = profile_likelihood_.MeanOffset();
  const auto [journey, best] = FindBest(options_.tolerance_steps);
  position.journey = static_cast<int>(journey);
  const RouteBelief& belief = beliefs_[journey];
  position.step = best.step;
  position.interval_first = best.first;
  position.interval_last = best.last;
  position.probability = (1 - position.unknown_probability) * std::clamp(best.mass, 0.0, 1.0);
  position.outcome =
      position.probability >= options_.match_probability ? Outcome::kMatch : Outcome::kAmbiguous;
  const auto last_step = static_cast<double>(std::max<std::int64_t>(1, belief.step_count() - 1));
  position.progress_home = 1 - static_cast<double>(best.step) / last_step;
  position.direction = DirectionOf(belief.DirectionMass(best.first, best.last));
  return position;
}

}  // namespace homing
