// Whether answers are as sure as they are right.
#ifndef TESTS_ACCURACY_HONESTY_H_
#define TESTS_ACCURACY_HONESTY_H_

#include <vector>

#include "tests/accuracy/run.h"
#include "tests/accuracy/scores.h"

namespace homing::accuracy {

// Of Homing's answers at judged instants; right as Run::RightEnough.
struct MatchCount {
  int answers = 0;
  int matches = 0;
  int right = 0;

  int wrong() const { return matches - right; }
  double MatchShare() const { return answers == 0 ? 0 : 1.0 * matches / answers; }
  double RightShare() const { return matches == 0 ? 1 : 1.0 * right / matches; }
};
MatchCount CountMatches(const std::vector<const Run*>& runs);

// As Judge, right as Run::RightEnough.
std::vector<Judgement> JudgeEnough(const std::vector<const Run*>& runs);

// The expected calibration error that as many answers of these probabilities have if each is right
// just as often as it says: mean of 1,000 draws.
double PerfectCalibrationError(const std::vector<Judgement>& judgements);

// Answers of Homing whose outcome, probability and on_route do not agree: MATCH exactly from
// probability 0.90 on, UNKNOWN_PLACE exactly up to on_route 0.50, probability at most on_route.
int CountDisagreements(const std::vector<const Run*>& runs);

}  // namespace homing::accuracy

#endif  // TESTS_ACCURACY_HONESTY_H_
