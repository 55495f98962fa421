#include "homing/landmark/landmark_options.h"

#include <string>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"

namespace homing {
namespace {

absl::Status CheckWithin(const std::string& field, double value, double low, double high) {
  if (value >= low && value <= high) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat("landmark.", field, " ", value, " is outside [", low, ", ", high, "]"));
}

// As CheckWithin from 0, but 0 itself is outside.
absl::Status CheckPositive(const std::string& field, double value, double high) {
  if (value > 0 && value <= high) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat("landmark.", field, " ", value, " is outside (0, ", high, "]"));
}

}  // namespace

absl::Status Validate(const LandmarkOptions& options) {
  HOMING_RETURN_IF_ERROR(CheckWithin("min_vector_length_px", options.min_vector_length_px, 0, 50));
  HOMING_RETURN_IF_ERROR(CheckWithin("min_vectors", options.min_vectors, 1, 1000));
  HOMING_RETURN_IF_ERROR(CheckWithin("histogram_bins", options.histogram_bins, 4, 256));
  HOMING_RETURN_IF_ERROR(CheckPositive("max_valley_ratio", options.max_valley_ratio, 1));
  HOMING_RETURN_IF_ERROR(CheckPositive("min_peak_share", options.min_peak_share, 0.5));
  HOMING_RETURN_IF_ERROR(
      CheckPositive("max_track_distance_px", options.max_track_distance_px, 500));
  return CheckWithin("max_track_gap_steps", options.max_track_gap_steps, 0, 20);
}

}  // namespace homing
