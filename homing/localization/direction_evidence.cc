#include "homing/localization/direction_evidence.h"

#include <cmath>
#include <cstddef>

namespace homing {
namespace {

// Exponent of what one sign says. A robot that turns shows the wrong sign for many observations.
constexpr double kSignWeight = 0.3;

}  // namespace

std::array<double, 2> DirectionFactors(const RouteScale& route, const SeenProfiles& profiles,
                                       double weight) {
  double odds = 0;
  for (std::size_t side = 0; side < profiles.size(); ++side) {
    if (!route.sides[side] || !profiles[side]) continue;
    odds += route.sides[side]->odometer.OutwardLogOdds(profiles[side]->odometer());
  }
  odds *= kSignWeight * weight;
  return {2 / (1 + std::exp(odds)), 2 / (1 + std::exp(-odds))};
}

}  // namespace homing
