// Training of the deviation model (paper III, eqs 6 to 8, Figs 1, 2).
#ifndef HOMING_SIMILARITY_DEVIATION_TRAINING_H_
#define HOMING_SIMILARITY_DEVIATION_TRAINING_H_

#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "homing/similarity/deviation_model.h"

namespace homing {

// One point past which a pinhole camera drives n times, at random velocity C and distance D (eq 6).
struct TrainingOptions {
  // Camera, pixels. width, height >= 16; focal > 0.
  int width = 320;
  int height = 240;
  double focal_px = 277;
  // n of eq 7. [10, 1'000'000].
  int observations = 1000;
  std::uint64_t seed = 1;
  // C ~ N(mean, deviation) km/h; draws that are not positive are drawn again.
  double velocity_mean_kmh = 4;
  double velocity_deviation_kmh = 1;
  // D ~ N(mean, deviation) m; draws under 2 m are drawn again.
  double distance_mean_m = 11;
  double distance_deviation_m = 3;
  // Position of the point at t = 0 relative to the camera, along the travel and vertically, m; the
  // time after which the vector is observed, s; and the frame interval of the vector, s. Chosen so
  // that the median over seeds is the paper's mu 2.24 and sigma 0.86.
  double lateral_offset_m = 2.75;
  double vertical_offset_m = 0.5;
  double elapsed_s = 1.1;
  double frame_interval_s = 0.1;
};

// INVALID_ARGUMENT naming field, value and limit.
absl::Status Validate(const TrainingOptions& options);

struct ImagePoint {
  double x = 0;
  double y = 0;
};

// The midpoint of the point's vector, seen by a pinhole camera that drives past at `velocity_kmh`
// and `distance_m`, the elapsed time after the start.
ImagePoint TrainingMidpoint(const TrainingOptions& options, double velocity_kmh, double distance_m);

// chi_k: how far each point is from the mean of all (eqs 7, 8). REQUIRES: not empty.
std::vector<double> DeviationsFromMean(const std::vector<ImagePoint>& points);

// The log-normal of greatest likelihood, mu = mean(ln chi), sigma = deviation(ln chi), with the
// Kolmogorov-Smirnov distance of the fit. INVALID_ARGUMENT: a deviation of zero, or all alike.
absl::StatusOr<DeviationModel> FitDeviationModel(const std::vector<double>& deviations_px);

struct TrainingResult {
  DeviationModel model;
  // chi_k (eq 8), pixels, in the order drawn.
  std::vector<double> deviations_px;
};

// Same options, same result. INVALID_ARGUMENT: Validate.
absl::StatusOr<TrainingResult> TrainDeviationModel(const TrainingOptions& options);

}  // namespace homing

#endif  // HOMING_SIMILARITY_DEVIATION_TRAINING_H_
