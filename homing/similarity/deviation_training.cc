#include "homing/similarity/deviation_training.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"

namespace homing {
namespace {

constexpr double kMetresPerSecond = 1.0 / 3.6;
constexpr double kLeastDistance = 2.0;

// The standard library's normal distribution differs between implementations; this one does not.
class Normal {
 public:
  explicit Normal(std::uint64_t seed) : engine_(seed) {}

  // Box and Muller's transform; the second of its pair is not used.
  double Draw(double mean, double deviation) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - Uniform()));
    return mean + deviation * radius * std::cos(2.0 * std::numbers::pi * Uniform());
  }

 private:
  // [0, 1) in steps of 2^-53.
  double Uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }

  std::mt19937_64 engine_;
};

// Equation (6): C and D are independent.
std::vector<ImagePoint> Observe(const TrainingOptions& options) {
  Normal normal(options.seed);
  std::vector<ImagePoint> points;
  points.reserve(static_cast<std::size_t>(options.observations));
  for (int k = 0; k < options.observations; ++k) {
    double c = 0;
    while (c <= 0) {
      c = normal.Draw(options.velocity_mean_kmh, options.velocity_deviation_kmh);
    }
    double d = 0;
    while (d < kLeastDistance) {
      d = normal.Draw(options.distance_mean_m, options.distance_deviation_m);
    }
    points.push_back(TrainingMidpoint(options, c, d));
  }
  return points;
}

// The greatest distance between the fitted and the empirical distribution.
double KolmogorovSmirnovDistance(const DeviationModel& model, std::vector<double> sorted) {
  std::sort(sorted.begin(), sorted.end());
  const double n = static_cast<double>(sorted.size());
  double distance = 0;
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    const double f = Cdf(model, sorted[k]);
    const double below = static_cast<double>(k) / n;
    const double above = static_cast<double>(k + 1) / n;
    distance = std::max({distance, f - below, above - f});
  }
  return distance;
}

}  // namespace

absl::Status Validate(const TrainingOptions& options) {
  HOMING_RETURN_IF_ERROR(CheckRange("width", options.width, 16, 65536));
  HOMING_RETURN_IF_ERROR(CheckRange("height", options.height, 16, 65536));
  HOMING_RETURN_IF_ERROR(CheckAbove("focal_px", options.focal_px, 0.0, 1e6));
  HOMING_RETURN_IF_ERROR(CheckRange("observations", options.observations, 10, 1'000'000));
  HOMING_RETURN_IF_ERROR(CheckAbove("velocity_mean_kmh", options.velocity_mean_kmh, 0.0, 1000.0));
  HOMING_RETURN_IF_ERROR(
      CheckAbove("velocity_deviation_kmh", options.velocity_deviation_kmh, 0.0, 1000.0));
  HOMING_RETURN_IF_ERROR(
      CheckRange("distance_mean_m", options.distance_mean_m, kLeastDistance, 10000.0));
  HOMING_RETURN_IF_ERROR(
      CheckAbove("distance_deviation_m", options.distance_deviation_m, 0.0, 10000.0));
  HOMING_RETURN_IF_ERROR(CheckRange("lateral_offset_m", options.lateral_offset_m, -1000.0, 1000.0));
  HOMING_RETURN_IF_ERROR(
      CheckRange("vertical_offset_m", options.vertical_offset_m, -1000.0, 1000.0));
  HOMING_RETURN_IF_ERROR(CheckRange("elapsed_s", options.elapsed_s, 0.0, 3600.0));
  return CheckAbove("frame_interval_s", options.frame_interval_s, 0.0, 3600.0);
}

ImagePoint TrainingMidpoint(const TrainingOptions& options, double velocity_kmh,
                            double distance_m) {
  const double velocity_mps = velocity_kmh * kMetresPerSecond;
  const double scale = options.focal_px / distance_m;
  const double start = options.lateral_offset_m - velocity_mps * options.elapsed_s;
  const double end = start - velocity_mps * options.frame_interval_s;
  return {0.5 * options.width + scale * 0.5 * (start + end),
          0.5 * options.height + scale * options.vertical_offset_m};
}

std::vector<double> DeviationsFromMean(const std::vector<ImagePoint>& points) {
  // Equation (7).
  ImagePoint mean;
  for (const ImagePoint& point : points) {
    mean.x += point.x / static_cast<double>(points.size());
    mean.y += point.y / static_cast<double>(points.size());
  }
  // Equation (8).
  std::vector<double> deviations;
  deviations.reserve(points.size());
  for (const ImagePoint& point : points) {
    deviations.push_back(std::hypot(point.x - mean.x, point.y - mean.y));
  }
  return deviations;
}

absl::StatusOr<DeviationModel> FitDeviationModel(const std::vector<double>& deviations_px) {
  const double n = static_cast<double>(deviations_px.size());
  double sum = 0;
  for (const double chi : deviations_px) {
    sum += std::log(chi);
  }
  DeviationModel model;
  model.mu = sum / n;
  double squares = 0;
  for (const double chi : deviations_px) {
    squares += std::pow(std::log(chi) - model.mu, 2);
  }
  model.sigma = std::sqrt(squares / n);
  model.observations = static_cast<int>(deviations_px.size());
  HOMING_RETURN_IF_ERROR(Validate(model));
  model.ks_distance = KolmogorovSmirnovDistance(model, deviations_px);
  return model;
}

absl::StatusOr<TrainingResult> TrainDeviationModel(const TrainingOptions& options) {
  HOMING_RETURN_IF_ERROR(Validate(options));
  TrainingResult result;
  result.deviations_px = DeviationsFromMean(Observe(options));
  HOMING_ASSIGN_OR_RETURN(result.model, FitDeviationModel(result.deviations_px));
  result.model.width = options.width;
  result.model.height = options.height;
  return result;
}

}  // namespace homing
