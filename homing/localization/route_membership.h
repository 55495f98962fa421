// The belief that the robot is on one of the routes at all.
#ifndef HOMING_LOCALIZATION_ROUTE_MEMBERSHIP_H_
#define HOMING_LOCALIZATION_ROUTE_MEMBERSHIP_H_

namespace homing {

// The logarithm of the odds of being on the route, bounded: however long a route has fitted,
// another may begin. Not thread-safe.
class RouteMembership {
 public:
  // REQUIRES: 0 <= off_route_prior < 1.
  explicit RouteMembership(double off_route_prior);

  // `evidence`: logarithm of how much likelier the observation is on the route than off it.
  void Add(double evidence);
  // Drops the evidence for the route, if there is more for it than against it: the odds are even.
  void DropEvidence();
  // Raises the odds to slightly above even, if they are lower.
  void StayPossible();
  // Call it after a fraction of the mass has passed an end of the route. [0, 1].
  void Leave(double fraction);
  // Call it when the rest of the mass fits the view `ratio` times as well as a random place does.
  // Positive.
  void Fit(double ratio);

  // By the evidence the probability is 0.98 or more. Mass that has left does not count.
  bool IsSure() const;
  // Probability of being on the route.
  double OnRoute() const;

 private:
  double log_odds_;
  // Probability that the robot has passed an end, if it was on the route before.
  double left_ = 0;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_ROUTE_MEMBERSHIP_H_
