// Scores of answers, by the field's usual measures.
#ifndef TESTS_ACCURACY_SCORES_H_
#define TESTS_ACCURACY_SCORES_H_

#include <vector>

#include "tests/accuracy/run.h"

namespace homing::accuracy {

struct Judgement {
  bool right = false;
  double score = 0;
};

// Of the judged instants of all runs, by one method.
std::vector<Judgement> Judge(const std::vector<const Run*>& runs, const Answers Run::*method);

// Share of right answers, 0..1.
double Recall(const std::vector<Judgement>& judgements);

struct PrecisionRecall {
  struct Point {
    double recall = 0;
    double precision = 0;
  };
  // From the surest answer on.
  std::vector<Point> curve;
  // Average precision, 0..1.
  double area = 0;
  // Greatest recall without a wrong answer, 0..1.
  double recall_at_full_precision = 0;
};

PrecisionRecall PrecisionRecallOf(std::vector<Judgement> judgements);

struct Calibration {
  struct Bin {
    double probability = 0;
    double right = 0;
  };
  // Ten of equal mass, the least sure first.
  std::vector<Bin> bins;
  double expected_error = 0;
  double brier = 0;
};

// REQUIRES: scores are probabilities.
Calibration CalibrationOf(std::vector<Judgement> judgements);
// The same of judgements in ascending order of score.
Calibration SortedCalibrationOf(const std::vector<Judgement>& judgements);

// Of the judged instants with a place, units of place; NaN if none.
double MedianError(const std::vector<const Run*>& runs, const Answers Run::*method);

// Observations until the first right MATCH, from the first that makes a step on; as many as there
// are if there is none.
double TimeToMatch(const Run& run);
// Median over the runs.
double MedianTimeToMatch(const std::vector<const Run*>& runs);

// Share of all answers that are `outcome`.
double Share(const std::vector<const Run*>& runs, Outcome outcome);
// The same from the 50th answer of each run on, from the middle of a shorter one.
double LateShare(const std::vector<const Run*>& runs, Outcome outcome);

// 0 if there are none.
double Mean(const std::vector<double>& values);
// NaN if there are none.
double Median(std::vector<double> values);

}  // namespace homing::accuracy

#endif  // TESTS_ACCURACY_SCORES_H_
