#include "homing/similarity/deviation_model.h"

#include <cmath>
#include <numbers>

#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"

namespace homing {

absl::Status Validate(const DeviationModel& model) {
  HOMING_RETURN_IF_ERROR(CheckRange("mu", model.mu, -100.0, 100.0));
  HOMING_RETURN_IF_ERROR(CheckAbove("sigma", model.sigma, 0.0, 100.0));
  HOMING_RETURN_IF_ERROR(CheckRange("observations", model.observations, 0, 1'000'000'000));
  HOMING_RETURN_IF_ERROR(CheckRange("ks_distance", model.ks_distance, 0.0, 1.0));
  HOMING_RETURN_IF_ERROR(CheckRange("width", model.width, 0, 1'000'000));
  return CheckRange("height", model.height, 0, 1'000'000);
}

double Cdf(const DeviationModel& model, double delta_px) {
  if (delta_px <= 0) {
    return 0;
  }
  // Equation (9).
  return 0.5 * std::erfc(-(std::log(delta_px) - model.mu) / (model.sigma * std::numbers::sqrt2));
}

double Survival(const DeviationModel& model, double delta_px) {
  if (delta_px <= 0) {
    return 1;
  }
  // Equation (14) by the symmetry of erfc: no cancellation where F is near 1.
  return 0.5 * std::erfc((std::log(delta_px) - model.mu) / (model.sigma * std::numbers::sqrt2));
}

double Pdf(const DeviationModel& model, double delta_px) {
  if (delta_px <= 0) {
    return 0;
  }
  // Equation (10).
  const double z = (std::log(delta_px) - model.mu) / model.sigma;
  return std::exp(-0.5 * z * z) / (delta_px * model.sigma * std::sqrt(2.0 * std::numbers::pi));
}

}  // namespace homing
