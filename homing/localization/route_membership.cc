#include "homing/localization/route_membership.h"

#include <algorithm>
#include <cmath>

namespace homing {

RouteMembership::RouteMembership(double off_route_prior)
    : log_odds_(std::log(off_route_prior / (1 - off_route_prior))) {}

void RouteMembership::Add(double evidence, const MembershipRates& rates) {
  log_odds_ -= (started_ ? rates.weight : rates.first_weight) * evidence;
  log_odds_ = std::clamp(log_odds_, rates.least_log_odds, rates.most_log_odds);
  started_ = true;
}

double RouteMembership::OffRoute() const { return 1 / (1 + std::exp(-log_odds_)); }

}  // namespace homing
