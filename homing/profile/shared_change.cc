#include "homing/profile/shared_change.h"

#include <algorithm>
#include <cmath>

namespace homing {
namespace {

// Least fraction that a different place is taken to share, and the margin of the threshold above
// that fraction.
constexpr double kLeastShared = 0.14;
constexpr double kAboveDifferent = 0.03;
// Correlation lengths after which the first, shorter stretch is compared.
constexpr double kFirstLengths = 1;
// Instants closer together than this part of the stretch are not kept.
constexpr double kSpacing = 1.0 / 16;
constexpr std::size_t kMostInstants = 32;

std::span<const FlowProfile> ProfilesOf(std::span<const JourneyRef> journeys,
                                        const BelievedInstant& at, std::size_t side) {
  return journeys[at.journey].map->profiles(Side{static_cast<int>(side)});
}

// How much nearer the view is to its own place than to the other instant's place.
int Preference(const BelievedInstant::Seen& seen, const FlowProfile& own,
               const FlowProfile& other) {
  const std::array<const FlowProfile*, 2> stored{&own, &other};
  std::array<std::uint16_t, 2> distances{};
  const ProfileView view{seen.profile, *seen.covered, distances};
  ProfileDistances({&view, 1}, std::span<const FlowProfile* const>(stored));
  return int{distances[1]} - int{distances[0]};
}

// Usual distance of places `lengths` correlation lengths apart.
double UsualDistance(const SideScale& side, double lengths) {
  const double part = std::clamp((lengths - 1) / (kStretchLengths - 1), 0.0, 1.0);
  return (1 - part) * double{side.length_distance} + part * double{side.stretch_distance};
}

// The shared fraction of the change between both instants, less the threshold; none if no side can
// be compared.
std::optional<double> ShareOf(std::span<const JourneyRef> journeys, const RouteScale& route,
                              const BelievedInstant& now, const BelievedInstant& then) {
  const double lengths = std::abs(now.moved - then.moved) / route.correlation_steps;
  double sum = 0, count = 0;
  std::size_t sides = 0;
  for (std::size_t side = 0; side < now.seen.size(); ++side) {
    const auto here = ProfilesOf(journeys, now, side), there = ProfilesOf(journeys, then, side);
    if (!now.seen[side] || !then.seen[side] || here.empty() || there.empty()) continue;
    const FlowProfile& now_stored = here[static_cast<std::size_t>(now.step)];
    const FlowProfile& then_stored = there[static_cast<std::size_t>(then.step)];
    const int preference = Preference(*now.seen[side], now_stored, then_stored) +
                           Preference(*then.seen[side], then_stored, now_stored);
    sum += preference / (2 * UsualDistance(*route.sides[side], lengths));
    count += 1;
    sides |= std::size_t{1} << side;
  }
  if (count == 0) {
    return std::nullopt;
  }
  return sum / count - std::max(kLeastShared, double{route.different_share[sides]}) -
         kAboveDifferent;
}

}  // namespace

std::optional<double> SharedChange::Add(std::span<const JourneyRef> journeys,
                                        const RouteScale& route, const BelievedInstant& now) {
  const double stretch = kStretchLengths * route.correlation_steps;
  // The latest instant that is far enough behind; at first one that is less far.
  const auto away = [&now](const BelievedInstant& then) {
    return std::abs(now.moved - then.moved);
  };
  while (past_.size() > 1 && away(past_[1]) >= stretch) past_.pop_front();
  std::optional<double> shared;
  if (!past_.empty() && away(past_[0]) >= kFirstLengths * route.correlation_steps) {
    shared = ShareOf(journeys, route, now, past_[0]);
  }
  if (past_.empty() || away(past_.back()) >= kSpacing * stretch) {
    past_.push_back(now);
  }
  // A robot that drives to and fro adds instants without leaving the stretch.
  if (past_.size() > kMostInstants) past_.pop_front();
  return shared;
}

}  // namespace homing
