// The log-normal model of how far a landmark's mean deviates (paper III, eqs 9, 10).
#ifndef HOMING_SIMILARITY_DEVIATION_MODEL_H_
#define HOMING_SIMILARITY_DEVIATION_MODEL_H_

#include "absl/status/status.h"

namespace homing {

struct DeviationModel {
  // Log location and log scale of deviations in pixels; the paper's result is the default.
  double mu = 2.24;
  double sigma = 0.86;
  // Training observations; 0: built in.
  int observations = 0;
  // Kolmogorov-Smirnov distance of the fit, 0..1.
  double ks_distance = 0;
  // Camera it belongs to, pixels; 0: any.
  int width = 0;
  int height = 0;
  friend bool operator==(const DeviationModel&, const DeviationModel&) = default;
};

// INVALID_ARGUMENT: mu not in [-100, 100], sigma not in (0, 100], negative observations or sizes,
// ks_distance not in [0, 1].
absl::Status Validate(const DeviationModel& model);

// F(delta; mu, sigma) = erfc(-(ln delta - mu) / (sigma sqrt 2)) / 2 (eq 9); 0 for delta <= 0.
double Cdf(const DeviationModel& model, double delta_px);

// 1 - F(delta), exact far into the tail (eqs 9, 14); 1 for delta <= 0.
double Survival(const DeviationModel& model, double delta_px);

// f(delta; mu, sigma) (eq 10); 0 for delta <= 0.
double Pdf(const DeviationModel& model, double delta_px);

}  // namespace homing

#endif  // HOMING_SIMILARITY_DEVIATION_MODEL_H_
