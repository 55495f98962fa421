// How flow vectors become landmarks. Source: paper III, Fig. 4.
#ifndef HOMING_LANDMARK_LANDMARK_OPTIONS_H_
#define HOMING_LANDMARK_LANDMARK_OPTIONS_H_

#include "absl/status/status.h"

namespace homing {

// These options change the stored fingerprints, so they are stored with the journey.
struct LandmarkOptions {
  // Vectors shorter than this are outliers (III, Fig. 4). Source pixels. [0, 50].
  double min_vector_length_px = 0.5;
  // Fewest vectors of a landmark. [1, 1000].
  int min_vectors = 8;
  // Bins of the histogram of midpoints over the image width. [4, 256].
  int histogram_bins = 16;
  // A valley divides if its bin is at most this fraction of the lower peak. (0, 1].
  double max_valley_ratio = 0.5;
  // The lower peak's side holds at least this fraction of the vectors. (0, 0.5].
  double min_peak_share = 0.15;
  // A landmark at the next step is the same if its mean is this near to the place that the flow
  // predicts. (0, 500].
  double max_track_distance_px = 20;
  // Steps that a landmark may be missing and still be the same. [0, 20].
  int max_track_gap_steps = 2;
  friend bool operator==(const LandmarkOptions&, const LandmarkOptions&) = default;
};

// INVALID_ARGUMENT naming field, value and limit.
absl::Status Validate(const LandmarkOptions& options);

}  // namespace homing

#endif  // HOMING_LANDMARK_LANDMARK_OPTIONS_H_
