// Discrete Bayes filter over the steps of one or more journeys: the step, the direction, and
// whether the robot is on a route at all. Source: paper V (future work); docs/algorithm.md.
#ifndef HOMING_LOCALIZATION_POSITION_FILTER_H_
#define HOMING_LOCALIZATION_POSITION_FILTER_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "homing/flow/motion.h"
#include "homing/localization/distance_moved.h"
#include "homing/localization/flow_gap.h"
#include "homing/localization/followed_place.h"
#include "homing/localization/place_jump.h"
#include "homing/localization/route_belief.h"
#include "homing/localization/route_membership.h"
#include "homing/localization/step_likelihood.h"
#include "homing/localization/step_window.h"
#include "homing/matching/matcher.h"
#include "homing/profile/profile_likelihood.h"
#include "homing/profile/shared_change.h"

namespace homing {

enum class Outcome { kMatch = 1, kAmbiguous = 2, kUnknownPlace = 3 };
enum class Direction { kUnknown = 0, kHomeward = 1, kOutward = 2 };

struct PositionOptions {
  // Half width of the interval around the most probable step, steps. [0, 100000].
  int tolerance_steps = 10;
  // MATCH from this probability of the interval on. (0, 1].
  double match_probability = 0.90;
  // UNKNOWN_PLACE from this probability off the route on. (0, 1].
  double unknown_probability = 0.50;
  // Evidence for steps: the flow profiles, if the journeys have any; else, or if this is set, the
  // paper's P_T.
  bool paper_only = false;
  LikelihoodOptions likelihood;
  // Probability of being off the route before the first observation. [0, 1).
  double off_route_prior = 0.2;
  // Probability, for each step, that the robot was set down anywhere (uniform restart). [0, 1).
  double restart_probability = 1e-4;
};

absl::Status Validate(const PositionOptions& options);

// The robot's recent place on one of the journeys.
struct PositionPrior {
  int journey = 0;
  std::int64_t step = 0;
  Direction direction = Direction::kUnknown;
  // Probability that the robot is there, 0..1.
  double probability = 0;
  // As in Position.
  std::optional<double> path_offset;
};

// The filter's estimate. step, interval and progress are absent before the first moving observation
// and for UNKNOWN_PLACE.
struct Position {
  Outcome outcome = Outcome::kAmbiguous;
  // Index into the journeys.
  int journey = 0;
  std::optional<std::int64_t> step;
  std::int64_t interval_first = 0;
  std::int64_t interval_last = 0;
  // Probability of the interval, 0..1.
  double probability = 0;
  // Probability of being off every route, 0..1. `probability` is at most 1 - this.
  double unknown_probability = 0;
  // Steps an observation, negative towards home; absent before the robot has moved.
  std::optional<double> speed_ratio;
  // Posterior mean of the offset to the left of the ROUTE, in scene distances: metres divided by
  // the mean distance of the seen objects. Absent without an estimate.
  std::optional<double> path_offset;
  double progress_home = 0;
  Direction direction = Direction::kUnknown;
};

// Not thread-safe. Causal: an answer uses no later observation.
class PositionFilter {
 public:
  // REQUIRES: Validate(options).ok().
  explicit PositionFilter(const PositionOptions& options);

  // Starts the belief at a place. REQUIRES: no Update yet; the journeys of the first one.
  // INVALID_ARGUMENT: step or probability out of range.
  absl::Status Start(std::span<const JourneyRef> journeys, const PositionPrior& prior);

  // One observation. The journeys must be the same, in the same order, at each call; a map may have
  // grown (it is still being recorded). Motion::kStanding changes nothing; without anything seen
  // the filter only predicts.
  Position Update(std::span<const JourneyRef> journeys, Motion motion, const SeenSides& seen,
                  const SeenProfiles& profiles = {});

  // Masses after the last observation, by journey, of the steps that are held one by one.
  const std::vector<StepMass>& masses() const { return masses_; }

 private:
  // Adds new journeys and steps to the belief.
  void Grow(std::span<const JourneyRef> journeys);
  void Predict(Motion motion);
  void Correct(std::span<const JourneyRef> journeys, const SeenSides& seen,
               const SeenProfiles& profiles);
  void CorrectByProfiles(std::span<const JourneyRef> journeys, const SeenProfiles& profiles);
  void CorrectByLandmarks(std::span<const JourneyRef> journeys, const SeenSides& seen);
  // Masses of the active window, by journey.
  std::vector<StepMass> Masses() const;
  // Factors of the steps of a journey's active window.
  using Factors = std::function<std::span<const float>(std::size_t journey)>;
  // Mean of the factors over the robot's possible places.
  double MeanFactor(const Factors& factors) const;
  // Multiplies the steps of each journey's active window by their factors, the speeds by the
  // odometer's likelihoods, and the directions by those of the flow's sign. `weight`: that of the
  // observation.
  void Weigh(const SeenProfiles& profiles, double weight, const Factors& factors);
  // The interval of +- `half` steps, over all journeys, that holds the most mass.
  struct Best {
    std::size_t journey = 0;
    StepWindow window;
  };
  Best FindBest(std::int64_t half) const;
  // The same for the steps within kNearSteps.
  Best FindPlace() const;
  // Weight of an observation after so many steps: the fraction of it that is new (EvidenceWeight).
  // (0, 1].
  double WeightOfObservation(double moved) const;
  // After a jump of the believed place (PlaceJump) the evidence of the place before is dropped: the
  // odds of being on the route, and the instants of the shared change.
  void DropEvidenceAfterJump(const Best& place, double moved);
  // The shared change since an earlier instant (SharedChange).
  std::optional<double> SharedBy(std::span<const JourneyRef> journeys, const Best& place,
                                 double moved);
  // Adds the evidence of being on the route: the shared change, and the fit to the expected place,
  // as MeanFactor gives it.
  void AddMembership(double weight, std::optional<double> shared, double fit);
  // While the believed place is followed (FollowedPlace), it stays possible: what has changed along
  // the route is no evidence that the robot has left it.
  void KeepFollowedPlace(const Best& place, double moved);
  // Holds only the steps around the robot one by one if its place is known; else all.
  void FocusIfKnown();
  void Unfocus();
  // Makes the mass of all steps 1, where it was `mass`.
  void Normalise(double mass);
  Position Answer() const;

  PositionOptions options_;
  StepLikelihood likelihood_;
  ProfileLikelihood profile_likelihood_;
  RouteMembership membership_;
  DistanceMoved distance_;
  SharedChange shared_change_;
  FlowGap gap_;
  PlaceJump jump_;
  FollowedPlace followed_;
  // The flow of this observation does not show how far the robot moved.
  bool after_gap_ = false;
  // Steps from the first observation on, and those of the last one, as DistanceMoved reports them.
  double moved_ = 0;
  double last_moved_ = 1;
  // Beliefs by journey, if the robot is on a route. Together their mass is 1.
  std::vector<RouteBelief> beliefs_;
  // After the last observation, by journey.
  std::vector<StepMass> masses_;
  std::int64_t step_count_ = 0;
  // A moving observation was processed.
  bool started_ = false;
  // By journey.
  std::vector<std::shared_ptr<const SpeedEvidence>> speeds_;
  // Steps of the map when `speeds_` were made.
  std::vector<std::int64_t> speed_steps_;
  RouteBelief::Speed speed_;
  bool has_offset_ = false;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_POSITION_FILTER_H_
