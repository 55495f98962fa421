#include "homing/localization/route_membership.h"

#include <algorithm>
#include <cmath>

namespace homing {
namespace {

// The bounds limit the effect of a long past. A robot that was off the route for long is believed
// to be back after some observations that fit; one that was on it for long stays on it over a
// stretch that has changed.
constexpr double kLeastLogOdds = -3;
constexpr double kMostLogOdds = 8;
constexpr double kSureLogOdds = 4;
// A probability of 0.55: the place is reported, but it is no MATCH.
constexpr double kPossibleLogOdds = 0.2;
// It may come back.
constexpr double kMostLeft = 0.95;

}  // namespace

RouteMembership::RouteMembership(double off_route_prior)
    : log_odds_(std::log((1 - off_route_prior) / std::max(off_route_prior, 1e-9))) {}

void RouteMembership::Add(double evidence) {
  log_odds_ = std::clamp(log_odds_ + evidence, kLeastLogOdds, kMostLogOdds);
}

void RouteMembership::DropEvidence() { log_odds_ = std::min(log_odds_, 0.0); }

void RouteMembership::StayPossible() { log_odds_ = std::max(log_odds_, kPossibleLogOdds); }

bool RouteMembership::IsSure() const { return log_odds_ >= kSureLogOdds; }

void RouteMembership::Leave(double fraction) {
  left_ = std::min(left_ + (1 - left_) * fraction, kMostLeft);
}

void RouteMembership::Fit(double ratio) { left_ /= left_ + (1 - left_) * ratio; }

double RouteMembership::OnRoute() const { return (1 - left_) / (1 + std::exp(-log_odds_)); }

}  // namespace homing
