// One way home on one or more recorded drives, and what each method answered. Source: own design.
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
  Outcome outcome = Outcome::kAmbiguous;
};

using Answers = std::vector<Answer>;

struct Run {
  // "laps", "street same".
  std::string set;
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
  int tolerance_steps = 10;
  // Only instants further than this from the first are judged.
  double after = 0;

  // By instant.
  Answers homing;
  Answers single_frame;
  Answers seq_slam_5;
  Answers seq_slam_10;
  Answers pictures;

  bool Judged(std::size_t i) const {
    return !std::isnan(query[i]->place) &&
           (after <= 0 || std::abs(query[i]->place - query[0]->place) > after);
  }
  bool Right(const Answer& answer, std::size_t i) const {
    return !foreign && answer.map == true_map &&
           std::abs(answer.place - query[i]->place) <= tolerance;
  }
};

}  // namespace homing::accuracy

#endif  // TESTS_ACCURACY_RUN_H_
