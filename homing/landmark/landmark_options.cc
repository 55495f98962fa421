#include "homing/landmark/landmark_options.h"

#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"

namespace homing {

absl::Status Validate(const LandmarkOptions& options) {
  HOMING_RETURN_IF_ERROR(
      CheckRange("min_vector_length_px", options.min_vector_length_px, 0.0, 50.0, "px"));
  HOMING_RETURN_IF_ERROR(CheckRange("min_vectors", options.min_vectors, 1, 1000));
  HOMING_RETURN_IF_ERROR(CheckRange("histogram_bins", options.histogram_bins, 4, 256));
  HOMING_RETURN_IF_ERROR(CheckAbove("max_valley_ratio", options.max_valley_ratio, 0.0, 1.0));
  HOMING_RETURN_IF_ERROR(CheckAbove("min_peak_share", options.min_peak_share, 0.0, 0.5));
  HOMING_RETURN_IF_ERROR(
      CheckAbove("max_track_distance_px", options.max_track_distance_px, 0.0, 500.0, "px"));
  return CheckRange("max_track_gap_steps", options.max_track_gap_steps, 0, 20, "steps");
}

}  // namespace homing
