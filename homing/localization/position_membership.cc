// PositionFilter's evidence of being on the route at all.
#include <algorithm>
#include <cmath>

#include "homing/localization/position_filter.h"

namespace homing {
namespace {

// An observation of full weight changes the log odds by kMembershipGain times the sum of two terms.
// The shared change in units of kSharedUnit, bounded by kMostShared. And the fit to the expected
// place, as a fraction of the greatest possible evidence, above kUsualFit in units of kFitUnit. A
// place that has changed fits badly too, so a bad fit is bounded by kLeastFit, a good one by 1.
constexpr double kMembershipGain = 0.5;
constexpr double kSharedUnit = 0.1;
constexpr double kMostShared = 2;
constexpr double kUsualFit = 0.22;
constexpr double kLeastFit = -0.3;
constexpr double kFitUnit = 0.4;
// Steps around the believed one that count for it, correlation lengths.
constexpr double kNearSteps = 1;

}  // namespace

PositionFilter::Best PositionFilter::FindPlace() const {
  const double length = profile_likelihood_.routes()[0]->correlation_steps;
  return FindBest(std::max<std::int64_t>(1, std::lround(kNearSteps * length)));
}

void PositionFilter::DropEvidenceAfterJump(const Best& place, double moved) {
  const auto& [journey, window] = place;
  const MapLength map{
      .steps = beliefs_[journey].step_count(),
      .correlation_steps = profile_likelihood_.routes()[journey]->correlation_steps};
  if (jump_.Update({journey, window.step, window.mass}, moved, map)) {
    membership_.DropEvidence();
    shared_change_ = {};
  }
}

std::optional<double> PositionFilter::SharedBy(std::span<const JourneyRef> journeys,
                                               const Best& place, double moved) {
  moved_ += moved;
  BelievedInstant now =
      profile_likelihood_.Believed(place.journey, place.window.first, place.window.last);
  now.moved = moved_;
  return shared_change_.Add(journeys, *profile_likelihood_.routes()[place.journey], now);
}

void PositionFilter::AddMembership(double weight, std::optional<double> shared, double fit) {
  const double most = ProfileRatio::kMostEvidence * weight * profile_likelihood_.compared();
  double evidence = std::clamp((std::log(fit) / most - kUsualFit) / kFitUnit, kLeastFit, 1.0);
  if (shared) evidence += std::clamp(*shared / kSharedUnit, -kMostShared, kMostShared);
  membership_.Add(kMembershipGain * weight * evidence);
}

void PositionFilter::KeepFollowedPlace(const Best& place, double moved) {
  const auto& [journey, window] = place;
  if (followed_.Update({journey, window.step, window.mass}, moved,
                       profile_likelihood_.routes()[journey]->correlation_steps,
                       membership_.IsSure())) {
    membership_.StayPossible();
  }
}

}  // namespace homing
