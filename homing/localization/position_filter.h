// Discrete Bayes filter over the steps of one or more journeys: where on the route, which way, and
// whether on it at all. Source: own design, following the paper's future work (V).
#ifndef HOMING_LOCALIZATION_POSITION_FILTER_H_
#define HOMING_LOCALIZATION_POSITION_FILTER_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "homing/flow/motion.h"
#include "homing/localization/route_belief.h"
#include "homing/localization/route_membership.h"
#include "homing/localization/step_likelihood.h"
#include "homing/localization/step_window.h"
#include "homing/matching/matcher.h"
#include "homing/profile/profile_likelihood.h"

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
  double restart_probability = 1e-9;
};

absl::Status Validate(const PositionOptions& options);

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
  // Off the route, 0..1.
  double unknown_probability = 0;
  double progress_home = 0;
  Direction direction = Direction::kUnknown;
};

// Not thread-safe. Causal: an answer uses no later observation.
class PositionFilter {
 public:
  // REQUIRES: Validate(options).ok().
  explicit PositionFilter(const PositionOptions& options);

  // One observation. The journeys must be the same, in the same order, at each call; a map may have
  // grown (it is still being recorded). Standing moves nothing; nothing seen only predicts.
  Position Update(std::span<const JourneyRef> journeys, Motion motion, const SeenSides& seen,
                  const SeenProfiles& profiles = {});

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
  // Multiplies each journey's steps in focus by its factors. Returns how likely the observation was
  // where the robot was believed to be, logarithm.
  double Weigh(const std::vector<StepMass>& predicted,
               const std::function<std::span<const float>(std::size_t)>& factors);
  // Where the robot is well known, only steps about there are held one by one; where it is not,
  // all.
  void FocusIfCalm();
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
  // By journey: where, if on a route at all. Together the mass is 1.
  std::vector<RouteBelief> beliefs_;
  // After the last observation, by journey.
  std::vector<StepMass> masses_;
  std::int64_t step_count_ = 0;
  // A moving observation has been taken.
  bool started_ = false;
  // Observations in a row that fitted where the robot was believed to be.
  int calm_ = 0;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_POSITION_FILTER_H_
