// Whether the robot is on one of the routes at all.
#ifndef HOMING_LOCALIZATION_ROUTE_MEMBERSHIP_H_
#define HOMING_LOCALIZATION_ROUTE_MEMBERSHIP_H_

namespace homing {

// The logarithm of the odds of being on the route, bounded: however long a route has fitted,
// another may begin.
class RouteMembership {
 public:
  // REQUIRES: 0 <= off_route_prior < 1.
  explicit RouteMembership(double off_route_prior);

  // `evidence`: logarithm of how much likelier the observation is on the route than off it.
  void Add(double evidence);
  // A fraction of the mass has left the route. [0, 1].
  void Leave(double fraction);

  // Probability of being on the route.
  double OnRoute() const;

 private:
  double log_odds_;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_ROUTE_MEMBERSHIP_H_
