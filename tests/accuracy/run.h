// One way home on one or more recorded drives, and what each method answered.
#ifndef TESTS_ACCURACY_RUN_H_
#define TESTS_ACCURACY_RUN_H_

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "homing/localization/position_filter.h"
#include "homing/matching/matcher.h"
#include "tests/accuracy/drive.h"

namespace homing::accuracy {

// What one method says of one instant.
struct Answer {
  // Index of the map, and place along it; NaN: none.
  int map = 0;
  double place = std::numeric_limits<double>::quiet_NaN();
  // How sure, the more the better; for Homing a probability.
  double score = 0;
  // For Homing alone.
  Outcome outcome = Outcome::kAmbiguous;
  double on_route = 1;
};

using Answers = std::vector<Answer>;

struct Run {
  // "laps", "office:2", "street same".
  std::string set;
  // Photographs or renderings of others; else our own simulation.
  bool real = false;
  std::vector<std::shared_ptr<const Drive>> maps;
  // Not of a route that the maps know: every step is wrong.
  bool foreign = false;
  // The map driven on.
  int true_map = 0;
  std::vector<const Instant*> query;
  // Keeps the instants alive.
  std::shared_ptr<const Drive> query_drive;
  Travel travel = Travel::kSame;
  // Greatest distance of a right answer, units of place.
  double tolerance = 1;
  // The truth was found by comparing pictures, and is not exact itself.
  bool truth_from_pictures = false;
  int tolerance_steps = 10;
  // Only instants further than this from the first are judged.
  double after = 0;
  // The route ends here (home: 0), units of place; what is driven beyond has no true step. NaN:
  // nothing is.
  double end = std::numeric_limits<double>::quiet_NaN();

  // By instant.
  Answers homing;
  Answers single_frame;
  Answers seq_slam_5;
  Answers seq_slam_10;
  Answers pictures;

  // The instants of the query that make a step, in order.
  std::vector<const Instant*> QuerySteps() const {
    std::vector<const Instant*> steps;
    for (const Instant* instant : query) {
      if (instant->MakesStep()) steps.push_back(instant);
    }
    return steps;
  }

  // Answers to QuerySteps() as answers by instant: at a frame that makes no step the last one
  // stands.
  Answers ByInstant(const Answers& by_step) const {
    Answers answers;
    std::size_t steps = 0;
    for (const Instant* instant : query) {
      steps += instant->MakesStep() ? 1 : 0;
      answers.push_back(steps == 0 ? Answer() : by_step.at(steps - 1));
    }
    return answers;
  }

  // Metres or frames beyond the end of the route; 0 or less: on it.
  double Beyond(std::size_t i) const {
    if (std::isnan(end)) return 0;
    return end > 0 ? query[i]->place - end : end - query[i]->place;
  }

  // The first frame of a stream can have no answer.
  bool Judged(std::size_t i) const {
    return !std::isnan(query[i]->place) && Beyond(i) <= 0 && (i > 0 || query[i]->MakesStep()) &&
           (after <= 0 || std::abs(query[i]->place - query[0]->place) > after);
  }
  bool Right(const Answer& answer, std::size_t i) const { return Within(answer, i, tolerance); }
  // The same where honesty is judged: a truth that comes from pictures is allowed to be half a
  // tolerance off.
  bool RightEnough(const Answer& answer, std::size_t i) const {
    return Within(answer, i, truth_from_pictures ? 1.5 * tolerance : tolerance);
  }

 private:
  bool Within(const Answer& answer, std::size_t i, double distance) const {
    return !foreign && Beyond(i) <= 0 && answer.map == true_map &&
           std::abs(answer.place - query[i]->place) <= distance;
  }
};

}  // namespace homing::accuracy

#endif  // TESTS_ACCURACY_RUN_H_
