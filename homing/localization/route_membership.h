// Whether the robot is on one of the routes at all, apart from where on it. Source: own design.
#ifndef HOMING_LOCALIZATION_ROUTE_MEMBERSHIP_H_
#define HOMING_LOCALIZATION_ROUTE_MEMBERSHIP_H_

namespace homing {

// Places look alike for metres, so that what consecutive observations say about the route is not
// independent: each counts for a fraction, the first for most. And however long a route has fitted,
// another may begin: the odds are bounded.
struct MembershipRates {
  // Weight of the evidence of the first observation, and of each further one. Positive.
  double first_weight = 1;
  double weight = 1;
  // Bounds of the logarithm of the odds of being off the route.
  double least_log_odds = 0;
  double most_log_odds = 0;
};

class RouteMembership {
 public:
  // REQUIRES: 0 <= off_route_prior < 1.
  explicit RouteMembership(double off_route_prior);

  // `evidence`: logarithm of how much likelier the observation is on the believed steps than off
  // the route.
  void Add(double evidence, const MembershipRates& rates);

  // Probability of being off the route.
  double OffRoute() const;

 private:
  double log_odds_;
  bool started_ = false;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_ROUTE_MEMBERSHIP_H_
