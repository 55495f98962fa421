#include "homing/localization/position_filter.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"
#include "homing/localization/direction_evidence.h"
#include "homing/localization/speed_ratios.h"

namespace homing {
namespace {

// Less on the route is nothing.
constexpr double kNoMass = 1e-12;
// The active window holds steps of at least this mass, and of at least so many times what a restart
// gives to each step: with one camera or short steps an observation says too little to weigh that
// away. The window is used while the robot is on the route and at one place with at least these
// probabilities.
constexpr double kFarMass = 1e-9;
constexpr double kFarRestarts = 2;
constexpr double kKnownOnRoute = 0.95;
constexpr double kKnownPlace = 0.999;
// A robot that advances more steps an observation is followed by jumps alone, so all steps are
// held.
constexpr double kFollowedSpeed = 0.75 * kSpeeds.back();
// The paper's P_T alone: log odds by observation, bounded by RouteMembership.
constexpr double kLandmarkWeight = 1;
// What an observation after a gap weighs: its few vectors are seldom those of the place.
constexpr double kGapWeight = 0.3;
// The robot may have been carried away while the link was down.
constexpr double kMostPrior = 0.95;
constexpr std::int16_t kNoRatio = SpeedEvidence::kNoRatio;

}  // namespace

PositionFilter::PositionFilter(const PositionOptions& options)
    : options_(options), likelihood_(options.likelihood), membership_(options.off_route_prior) {}

Position PositionFilter::Update(std::span<const JourneyRef> journeys, Motion motion,
                                const SeenSides& seen, const SeenProfiles& profiles) {
  Grow(journeys);
  if (motion != Motion::kStanding && step_count_ > 0) {
    after_gap_ = motion == Motion::kMoving && !options_.paper_only && gap_.Update(profiles);
    Predict(motion);
    if (motion == Motion::kMoving) {
      Correct(journeys, seen, profiles);
      started_ = true;
    }
  }
  return Answer();
}

absl::Status PositionFilter::Start(std::span<const JourneyRef> journeys,
                                   const PositionPrior& prior) {
  const std::int64_t steps = journeys[static_cast<std::size_t>(prior.journey)].map->step_count();
  if (steps == 0) {
    return absl::OkStatus();
  }
  HOMING_RETURN_IF_ERROR(CheckRange("prior.step", prior.step, std::int64_t{0}, steps - 1));
  HOMING_RETURN_IF_ERROR(CheckRange("prior.probability", prior.probability, 0.0, 1.0));
  Grow(journeys);
  const double mass = std::min(prior.probability, kMostPrior);
  for (RouteBelief& belief : beliefs_) belief.Scale(1 - mass);
  beliefs_[static_cast<std::size_t>(prior.journey)].Add(
      {.first = prior.step - options_.tolerance_steps,
       .last = prior.step + options_.tolerance_steps,
       .homeward = prior.direction != Direction::kOutward,
       .outward = prior.direction != Direction::kHomeward,
       .mass = mass});
  masses_ = Masses();
  membership_.Add(std::log(1 / (1 - mass)));
  if (prior.path_offset) profile_likelihood_.StartAtOffset(*prior.path_offset);
  started_ = true;
  return absl::OkStatus();
}

void PositionFilter::Grow(std::span<const JourneyRef> journeys) {
  const std::int64_t before = step_count_;
  step_count_ = 0;
  for (const JourneyRef& journey : journeys) step_count_ += journey.map->step_count();
  beliefs_.resize(journeys.size());
  if (!options_.paper_only) {
    profile_likelihood_.Grow(journeys);
  }
  speeds_.resize(journeys.size());
  speed_steps_.resize(journeys.size());
  for (std::size_t i = 0; i < journeys.size(); ++i) {
    static const RouteScale none;
    const RouteScale& route = options_.paper_only ? none : *profile_likelihood_.routes()[i];
    if (speeds_[i] && speed_steps_[i] == route.step_count) continue;
    speeds_[i] = SpeedEvidence::OfNoise(route.odometer_noise);
    speed_steps_[i] = route.step_count;
  }
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
  double lost = 0;
  for (std::size_t i = 0; i < beliefs_.size(); ++i) {
    RouteBelief& belief = beliefs_[i];
    if (motion == Motion::kMoving && started_) {
      const double before = belief.Mass();
      lost += before * (after_gap_ ? belief.MoveUnseen(restart)
                                   : belief.Move(speeds_[i]->change(), restart));
    } else if (motion == Motion::kTurning) {
      belief.Turn(restart);
    }
  }
  masses_ = Masses();
  if (lost > 0) {
    membership_.Leave(std::min(lost, 1.0));
  }
}

std::vector<StepMass> PositionFilter::Masses() const {
  std::vector<StepMass> masses;
  masses.reserve(beliefs_.size());
  for (const RouteBelief& belief : beliefs_) masses.push_back(belief.Masses());
  return masses;
}

void PositionFilter::Weigh(const SeenProfiles& profiles, double weight, const Factors& factors) {
  const bool is_unread = options_.paper_only || after_gap_;
  double after = 0;
  for (std::size_t i = 0; i < beliefs_.size(); ++i) {
    const std::vector<std::int16_t> ratios =
        is_unread ? std::vector<std::int16_t>(masses_[i].mass.size(), kNoRatio)
                  : SpeedRatios(*profile_likelihood_.routes()[i], masses_[i], profiles);
    const std::array<double, 2> directions =
        is_unread ? std::array<double, 2>{1, 1}
                  : DirectionFactors(*profile_likelihood_.routes()[i], profiles, weight);
    masses_[i] = beliefs_[i].Weigh(factors(i), ratios, *speeds_[i], directions);
    after += masses_[i].Sum() + beliefs_[i].MassBeyond();
  }
  Normalise(after);
  speed_ = {};
  for (const RouteBelief& belief : beliefs_) {
    const RouteBelief::Speed& speed = belief.mean_speed();
    const double mass = belief.MassWithin();
    speed_.absolute += mass * speed.absolute;
    speed_.outward += mass * speed.outward;
  }
}

double PositionFilter::MeanFactor(const Factors& factors) const {
  double fit = 0, before = 0;
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    const std::span<const float> of_journey = factors(i);
    for (std::size_t s = 0; s < masses_[i].mass.size(); ++s) {
      fit += double{masses_[i].mass[s]} * double{of_journey[s]};
      before += double{masses_[i].mass[s]};
    }
  }
  return std::max(fit, kNoMass) / std::max(before, kNoMass);
}

double PositionFilter::WeightOfObservation(double moved) const {
  if (!started_) {
    return 1;
  }
  double length = 1;
  double most = -1;
  for (std::size_t i = 0; i < beliefs_.size(); ++i) {
    const double mass = masses_[i].Sum();
    if (mass > most) {
      most = mass;
      length = profile_likelihood_.routes()[i]->correlation_steps;
    }
  }
  return EvidenceWeight(moved, length);
}

void PositionFilter::CorrectByProfiles(std::span<const JourneyRef> journeys,
                                       const SeenProfiles& profiles) {
  const double moved = distance_.Update(profile_likelihood_.routes(), masses_, profiles)
                           .value_or(std::copysign(std::min(1.0, speed_.absolute), last_moved_));
  last_moved_ = moved;
  const double weight = WeightOfObservation(moved) * (after_gap_ ? kGapWeight : 1);
  profile_likelihood_.Compute(journeys, profiles, masses_, weight);
  const double fit = MeanFactor([this](std::size_t i) { return profile_likelihood_.of(i); });
  membership_.Fit(fit);
  Weigh(profiles, weight, [this](std::size_t i) { return profile_likelihood_.of(i); });
  const Best place = FindPlace();
  DropEvidenceAfterJump(place, moved);
  AddMembership(weight, SharedBy(journeys, place, moved), fit);
  KeepFollowedPlace(place, moved);
  profile_likelihood_.Learn();
  profile_likelihood_.Release();
  has_offset_ = true;
  FocusIfKnown();
}

void PositionFilter::CorrectByLandmarks(std::span<const JourneyRef> journeys,
                                        const SeenSides& seen) {
  Unfocus();
  likelihood_.Compute(journeys, seen);
  const auto factors = [this](std::size_t i) { return std::span<const float>(likelihood_.of(i)); };
  const double fit = MeanFactor(factors);
  Weigh({}, 1, factors);
  membership_.Fit(fit / likelihood_.OffRoute());
  membership_.Add(kLandmarkWeight * (std::log(fit) - std::log(likelihood_.OffRoute())));
}

void PositionFilter::Correct(std::span<const JourneyRef> journeys, const SeenSides& seen,
                             const SeenProfiles& profiles) {
  if (!options_.paper_only && ProfileLikelihood::CanCompare(journeys, profiles)) {
    CorrectByProfiles(journeys, profiles);
  } else {
    CorrectByLandmarks(journeys, seen);
  }
}

void PositionFilter::FocusIfKnown() {
  const bool known = membership_.OnRoute() >= kKnownOnRoute && speed_.absolute <= kFollowedSpeed &&
                     FindBest(options_.tolerance_steps).window.mass >= kKnownPlace;
  if (!known) {
    Unfocus();
    return;
  }
  const double restart = options_.restart_probability / static_cast<double>(step_count_);
  const double least = std::max(kFarMass, kFarRestarts * restart);
  for (std::size_t i = 0; i < beliefs_.size(); ++i) {
    beliefs_[i].Focus(least, masses_[i]);
  }
  masses_ = Masses();
}

void PositionFilter::Unfocus() {
  for (RouteBelief& belief : beliefs_) belief.Unfocus();
  masses_ = Masses();
}

void PositionFilter::Normalise(double mass) {
  for (RouteBelief& belief : beliefs_) {
    if (mass > kNoMass) {
      belief.Scale(1 / mass);
    } else {
      // Nothing is left of the belief: the robot may be anywhere.
      const std::int64_t steps = belief.step_count();
      belief = RouteBelief();
      belief.Grow(steps, 1 / static_cast<double>(step_count_));
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

}  // namespace homing
