// Flow vectors of one camera to at most two landmarks, by the valley of the histogram of the
// midpoints along the direction of travel. Source: paper III, Fig. 4; eqs 11, 12.
#ifndef HOMING_LANDMARK_LANDMARK_FINDER_H_
#define HOMING_LANDMARK_LANDMARK_FINDER_H_

#include <optional>
#include <vector>

#include "homing/flow/flow_vector.h"
#include "homing/landmark/landmark_options.h"

namespace homing {

// A landmark as one camera sees it at one step, before it has a number.
struct SeenLandmark {
  // Mean of the midpoints (eqs 11, 12), rounded once to float32.
  float x = 0;
  float y = 0;
  // Number of vectors (r or s of eq 11, 12).
  int count = 0;
  // Mean flow, pixels a step.
  double flow_x = 0;
  double flow_y = 0;
  // Relative spread of the magnitudes: deviation / mean.
  double spread = 0;
};

// The steps of the search for the valley, for pictures and tests.
struct LandmarkSplit {
  // Vectors a bin over [0, width).
  std::vector<int> histogram;
  // x of the valley where there are two landmarks.
  std::optional<double> valley_x;
  // For each input vector: landmark 0 or 1, or -1 for an outlier.
  std::vector<int> assignment;
};

// Drops non-finite and short vectors, and divides the rest.
LandmarkSplit SplitAtValley(const FlowField& field, const LandmarkOptions& options);

// At most two, from low x to high x. REQUIRES: Validate(options).ok().
std::vector<SeenLandmark> FindLandmarks(const FlowField& field, const LandmarkOptions& options);

}  // namespace homing

#endif  // HOMING_LANDMARK_LANDMARK_FINDER_H_
