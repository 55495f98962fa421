// Discrete Bayes filter over the steps of one or more journeys: where on the route, which way, and
// whether on it at all.
#ifndef HOMING_LOCALIZATION_POSITION_FILTER_H_
#define HOMING_LOCALIZATION_POSITION_FILTER_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "homing/flow/motion.h"
#include "homing/localization/distance_moved.h"
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
  // What the filter weighs steps by: the flow profiles, where the journeys have any; else, or if
  // this is set, the paper's P_T.
  bool paper_only = false;
  LikelihoodOptions likelihood;
  // Off the route before anything was seen. [0, 1).
  double off_route_prior = 0.2;
  // Probability a step that the robot has been set down anywhere (uniform restart). [0, 1).
  double restart_probability = 1e-4;
};

absl::Status Validate(const PositionOptions& options);

// Where the robot was a moment ago, on one of the journeys.
struct PositionPrior {
  int journey = 0;
  std::int64_t step = 0;
  Direction direction = Direction::kUnknown;
  // Of the robot being there, 0..1.
  double probability = 0;
  // As in Position.
  std::optional<double> path_offset;
};

// What the filter believes. step, interval and progress are absent before the first moving
// observation and for UNKNOWN_PLACE.
struct Position {
  Outcome outcome = Outcome::kAmbiguous;
  // Index into the journeys.
  int journey = 0;
  std::optional<std::int64_t> step;
  std::int64_t interval_first = 0;
  std::int64_t interval_last = 0;
  // Of the interval, 0..1.
  double probability = 0;
  // Off every route, 0..1. `probability` is at most 1 - this.
  double unknown_probability = 0;
  // Steps an observation, negative towards home; absent before the robot has moved.
  std::optional<double> speed_ratio;
  // Posterior mean of the metres left of the outbound path over the distance of what is seen, left
  // of the ROUTE; absent without an estimate.
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
  // grown (it is still being recorded). Standing moves nothing; nothing seen only predicts.
  Position Update(std::span<const JourneyRef> journeys, Motion motion, const SeenSides& seen,
                  const SeenProfiles& profiles = {});

  // After the last observation: by journey, the steps that are held one by one and where the robot
  // may be among them.
  const std::vector<StepMass>& masses() const { return masses_; }

 private:
  // Takes up new journeys and steps.
  void Grow(std::span<const JourneyRef> journeys);
  void Predict(Motion motion);
  void Correct(std::span<const JourneyRef> journeys, const SeenSides& seen,
               const SeenProfiles& profiles);
  void CorrectByProfiles(std::span<const JourneyRef> journeys, const SeenProfiles& profiles);
  void CorrectByLandmarks(std::span<const JourneyRef> journeys, const SeenSides& seen);
  // By journey, of the steps in focus.
  std::vector<StepMass> Masses() const;
  // Of the steps of a journey's active window.
  using Factors = std::function<std::span<const float>(std::size_t journey)>;
  // Mean over where the robot may be.
  double MeanFactor(const Factors& factors) const;
  // Multiplies the steps of each journey's active window by its factors, the speeds by what the
  // odometer says, and the directions by what the sign of the flow says. `weight`: of the
  // observation.
  void Weigh(std::span<const JourneyRef> journeys, const SeenProfiles& profiles, double weight,
             const Factors& factors);
  // What this observation may say that the ones before have not: the steps that the robot has moved
  // over the correlation length of the map. (0, 1].
  double WeightOfObservation(double moved) const;
  // Evidence of being on the route: how the view has changed since a while ago (SharedChange), and
  // how well it fits where the robot was expected, as MeanFactor.
  std::optional<double> SharedBy(std::span<const JourneyRef> journeys, double moved);
  void AddMembership(double weight, std::optional<double> shared, double fit);
  // Where the robot is well known, only the steps around it are held one by one; else all.
  void FocusIfKnown();
  void Unfocus();
  // Makes the mass of all steps 1, where it was `mass`.
  void Normalise(double mass);
  // The interval of +- `half` steps, of all journeys, that holds the most.
  struct Best {
    std::size_t journey = 0;
    StepWindow window;
  };
  Best FindBest(std::int64_t half) const;
  Position Answer() const;

  PositionOptions options_;
  StepLikelihood likelihood_;
  ProfileLikelihood profile_likelihood_;
  RouteMembership membership_;
  DistanceMoved distance_;
  SharedChange shared_change_;
  // Steps from the first observation on, and those of the last one, as DistanceMoved tells them.
  double moved_ = 0;
  double last_moved_ = 1;
  // By journey: where, if on a route at all. Together the mass is 1.
  std::vector<RouteBelief> beliefs_;
  // After the last observation, by journey.
  std::vector<StepMass> masses_;
  std::int64_t step_count_ = 0;
  // A moving observation has been taken.
  bool started_ = false;
  // By journey.
  std::vector<SpeedEvidence> speeds_;
  // Steps of the map when `speeds_` were made.
  std::vector<std::int64_t> speed_steps_;
  RouteBelief::Speed speed_;
  bool has_offset_ = false;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_POSITION_FILTER_H_
