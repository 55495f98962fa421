// Pictures of the report: similarity matrix with the believed path, precision-recall, reliability.
#ifndef TESTS_ACCURACY_PICTURES_H_
#define TESTS_ACCURACY_PICTURES_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "tests/accuracy/run.h"
#include "tests/accuracy/scores.h"

namespace homing::accuracy {

// How alike each step of the map and each instant of the way home look (their flow profiles), where
// the robot was, and where it was believed to be. As Canvas.
absl::Status DrawSimilarityMatrix(const std::string& path, const Run& run);

struct NamedCurve {
  std::string name;
  PrecisionRecall curve;
};
absl::Status DrawPrecisionRecall(const std::string& path, const std::string& title,
                                 const std::vector<NamedCurve>& curves);

struct NamedCalibration {
  std::string name;
  Calibration calibration;
};
absl::Status DrawReliability(const std::string& path,
                             const std::vector<NamedCalibration>& calibrations);

}  // namespace homing::accuracy

#endif  // TESTS_ACCURACY_PICTURES_H_
