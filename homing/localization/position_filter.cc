#include "homing/localization/position_filter.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace homing {
namespace {

// Share of the moving mass that one direction must have to be told.
constexpr double kDirectionMargin = 0.6;
// Less on the route is nothing.
constexpr double kNoMass = 1e-30;
// Fitted: see docs/algorithm.md.
constexpr MembershipRates kByProfiles = {
    .first_weight = 2, .weight = 0.2, .least_log_odds = -5.5, .most_log_odds = 0.02};
// What not knowing where on the route, within so many steps, speaks against being on it, logarithm,
// for one side: places of a foreign route are like some here and some there.
constexpr double kDoubt = 0.60;
constexpr int kLeastDoubtSteps = 10;
constexpr MembershipRates kByLandmarks = {
    .first_weight = 1, .weight = 1, .least_log_odds = -30, .most_log_odds = 7.6};
// An observation whose likelihood ratio, for one side, has less than this logarithm does not fit:
// the robot may be anywhere.
constexpr double kLeastFit = 0.25;
// Observations in a row that must fit before far steps are no longer held one by one.
constexpr int kCalm = 6;
// Steps of less mass are far, then.
constexpr double kFarMass = 1e-9;
// The filter is cautious: of the intervals that it holds p for, 1 - (1 - p)^kCaution were right.
constexpr double kCaution = 2.3;

// Steps count from home.
Direction DirectionOf(const std::array<double, 2>& mass) {
  const double both = mass[0] + mass[1];
  if (mass[0] > kDirectionMargin * both) {
    return Direction::kHomeward;
  }
  return mass[1] > kDirectionMargin * both ? Direction::kOutward : Direction::kUnknown;
}

}  // namespace

PositionFilter::PositionFilter(const PositionOptions& options)
    : options_(options), likelihood_(options.likelihood), membership_(options.off_route_prior) {}

Position PositionFilter::Update(std::span<const JourneyRef> journeys, Motion motion,
                                const SeenSides& seen, const SeenProfiles& profiles) {
  Grow(journeys);
  if (motion != Motion::kStanding && step_count_ > 0) {
    Predict(motion);
    if (motion == Motion::kMoving) {
      Correct(journeys, seen, profiles);
      started_ = true;
    }
  }
  return Answer();
}

void PositionFilter::Grow(std::span<const JourneyRef> journeys) {
  const std::int64_t before = step_count_;
  step_count_ = 0;
  for (const JourneyRef& journey : journeys) {
    step_count_ += journey.map->step_count();
  }
  beliefs_.resize(journeys.size());
  if (before == step_count_) {
    return;
  }
  const double mean = 1 / static_cast<double>(before == 0 ? step_count_ : before);
  double mass = 0;
  for (std::size_t i = 0; i < journeys.size(); ++i) {
    beliefs_[i].Grow(journeys[i].map->step_count(), mean);
    mass += beliefs_[i].Mass();
  }
  Normalise(mass);
  masses_ = Masses();
}

void PositionFilter::Predict(Motion motion) {
  const double restart = options_.restart_probability / static_cast<double>(step_count_);
  for (RouteBelief& belief : beliefs_) {
    motion == Motion::kMoving ? belief.Move(restart) : belief.Turn(restart);
  }
  masses_ = Masses();
}

std::vector<StepMass> PositionFilter::Masses() const {
  std::vector<StepMass> masses;
  masses.reserve(beliefs_.size());
  for (const RouteBelief& belief : beliefs_) {
    masses.push_back(belief.Masses());
  }
  return masses;
}

// What ran off the ends was no way that the robot went: it does not count as predicted.
double PositionFilter::Weigh(const std::vector<StepMass>& predicted,
                             const std::function<std::span<const float>(std::size_t)>& factors) {
  double before = 0;
  double after = 0;
  for (std::size_t i = 0; i < beliefs_.size(); ++i) {
    const double beyond = beliefs_[i].MassBeyond();
    before += predicted[i].Sum() + beyond;
    masses_[i] = beliefs_[i].Weigh(factors(i));
    after += masses_[i].Sum() + beyond;
  }
  Normalise(after);
  return std::log(std::max(after, kNoMass) / std::max(before, kNoMass));
}

void PositionFilter::CorrectByProfiles(std::span<const JourneyRef> journeys,
                                       const SeenProfiles& profiles) {
  profile_likelihood_.Compute(journeys, profiles, masses_);
  const bool fits = profile_likelihood_.LogFit() >= kLeastFit;
  calm_ = fits ? calm_ + 1 : 0;
  const bool focused = std::ranges::any_of(beliefs_, &RouteBelief::IsFocused);
  if (!fits && focused) {
    Unfocus();
    profile_likelihood_.Compute(journeys, profiles, masses_);
  }
  const double evidence =
      Weigh(masses_, [this](std::size_t i) { return profile_likelihood_.of(i); });
  const double here = FindBest(std::max(options_.tolerance_steps, kLeastDoubtSteps)).window.mass;
  const double doubt = started_ ? kDoubt * (1 - std::clamp(here, 0.0, 1.0)) : 0;
  membership_.Add(evidence / profile_likelihood_.sides() - profile_likelihood_.OffRoute() - doubt,
                  kByProfiles);
  profile_likelihood_.Learn();
  FocusIfCalm();
}

void PositionFilter::CorrectByLandmarks(std::span<const JourneyRef> journeys,
                                        const SeenSides& seen) {
  Unfocus();
  calm_ = 0;
  likelihood_.Compute(journeys, seen);
  const double evidence =
      Weigh(masses_, [this](std::size_t i) { return std::span<const float>(likelihood_.of(i)); });
  membership_.Add(evidence - std::log(likelihood_.OffRoute()), kByLandmarks);
}

void PositionFilter::Correct(std::span<const JourneyRef> journeys, const SeenSides& seen,
                             const SeenProfiles& profiles) {
  if (!options_.paper_only && ProfileLikelihood::CanCompare(journeys, profiles)) {
    CorrectByProfiles(journeys, profiles);
  } else {
    CorrectByLandmarks(journeys, seen);
  }
}

void PositionFilter::FocusIfCalm() {
  if (calm_ < kCalm) {
    return;
  }
  for (std::size_t i = 0; i < beliefs_.size(); ++i) {
    beliefs_[i].Focus(kFarMass, masses_[i]);
  }
  masses_ = Masses();
}

void PositionFilter::Unfocus() {
  for (RouteBelief& belief : beliefs_) {
    belief.Unfocus();
  }
  masses_ = Masses();
}

void PositionFilter::Normalise(double mass) {
  for (std::size_t i = 0; i < beliefs_.size(); ++i) {
    if (mass > kNoMass) {
      beliefs_[i].Scale(1 / mass);
    } else {
      beliefs_[i].AddToEach(1 / static_cast<double>(step_count_));
    }
  }
  if (mass > kNoMass) {
    for (StepMass& of_journey : masses_) {
      for (float& value : of_journey.mass) {
        value /= static_cast<float>(mass);
      }
    }
  } else {
    masses_ = Masses();
  }
}

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
  position.unknown_probability = membership_.OffRoute();
  if (!started_) {
    return position;
  }
  if (position.unknown_probability >= options_.unknown_probability) {
    position.outcome = Outcome::kUnknownPlace;
    return position;
  }
  const auto [journey, best] = FindBest(options_.tolerance_steps);
  position.journey = static_cast<int>(journey);
  const RouteBelief& belief = beliefs_[journey];
  position.step = best.step;
  position.interval_first = best.first;
  position.interval_last = best.last;
  const double elsewhere = std::pow(1 - std::clamp(best.mass, 0.0, 1.0), kCaution);
  position.probability = (1 - position.unknown_probability) * (1 - elsewhere);
  position.outcome =
      position.probability >= options_.match_probability ? Outcome::kMatch : Outcome::kAmbiguous;
  const auto last_step = static_cast<double>(std::max<std::int64_t>(1, belief.step_count() - 1));
  position.progress_home = 1 - static_cast<double>(best.step) / last_step;
  position.direction = DirectionOf(belief.DirectionMass(best.first, best.last));
  return position;
}

}  // namespace homing
