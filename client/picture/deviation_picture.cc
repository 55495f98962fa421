#include "client/picture/deviation_picture.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_format.h"
#include "client/picture/axes.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

constexpr double kPlotWidth = 560;
constexpr double kPlotHeight = 360;
constexpr Box kPlotBox{58, 30, 480, 280};
constexpr int kDensityBins = 40;
constexpr int kCurvePoints = 400;

// Up to the 99th percentile: the tail of a log-normal is long.
double UpperEnd(std::vector<double> deviations) {
  std::sort(deviations.begin(), deviations.end());
  const auto at = static_cast<std::size_t>(0.99 * static_cast<double>(deviations.size() - 1));
  return std::max(1.0, deviations[at]);
}

std::vector<double> DensityHistogram(const std::vector<double>& deviations, double end) {
  std::vector<double> density(kDensityBins, 0.0);
  const double bin = end / kDensityBins;
  for (const double deviation : deviations) {
    const auto index = static_cast<std::size_t>(std::max(0.0, deviation / bin));
    if (index < density.size()) density[index] += 1.0;
  }
  for (double& value : density) value /= static_cast<double>(deviations.size()) * bin;
  return density;
}

template <typename Function>
std::vector<Point> Curve(const Axes& axes, double end, const Function& function) {
  std::vector<Point> points;
  for (int i = 0; i <= kCurvePoints; ++i) {
    const double x = end * i / kCurvePoints;
    points.push_back(axes.At(x, function(x)));
  }
  return points;
}

std::string FitText(const DeviationModel& model) {
  return absl::StrFormat("log-normal, μ = %.2f, σ = %.2f", model.mu, model.sigma);
}

}  // namespace

absl::Status DrawDeviationDensity(const std::string& path, const std::vector<double>& deviations_px,
                                  const DeviationModel& model) {
  HOMING_ASSIGN_OR_RETURN(Canvas canvas, Canvas::Create(path, kPlotWidth, kPlotHeight));
  const double end = UpperEnd(deviations_px);
  const auto density = DensityHistogram(deviations_px, end);
  const double mode = Pdf(model, std::exp(model.mu - model.sigma * model.sigma));
  const double highest = std::max(mode, *std::max_element(density.begin(), density.end()));
  Axes axes(&canvas, kPlotBox, {0, end}, {0, 1.1 * highest});
  axes.Draw({absl::StrFormat("Deviations of %d vectors from their mean", deviations_px.size()),
             "deviation, pixels", "density, 1 / pixel"});
  const double bin = end / kDensityBins;
  for (int i = 0; i < kDensityBins; ++i) {
    const double top = axes.Y(density[static_cast<std::size_t>(i)]);
    canvas.Fill({axes.X(i * bin) + 0.5, top, axes.X(bin) - axes.X(0) - 1, axes.Y(0) - top},
                WithAlpha(kSky, 0.8));
  }
  canvas.Polyline(Curve(axes, end, [&](double x) { return Pdf(model, x); }), kRed, 2);
  axes.Legend({{"training", kSky}, {FitText(model), kRed}});
  return canvas.Finish();
}

absl::Status DrawDeviationDistribution(const std::string& path,
                                       const std::vector<double>& deviations_px,
                                       const DeviationModel& model) {
  HOMING_ASSIGN_OR_RETURN(Canvas canvas, Canvas::Create(path, kPlotWidth, kPlotHeight));
  const double end = UpperEnd(deviations_px);
  Axes axes(&canvas, kPlotBox, {0, end}, {0, 1});
  axes.Draw({absl::StrFormat("Cumulative distribution (Kolmogorov-Smirnov distance %.3f)",
                             model.ks_distance),
             "deviation, pixels", "share of vectors"});
  std::vector<double> sorted = deviations_px;
  std::sort(sorted.begin(), sorted.end());
  std::vector<Point> steps = {axes.At(0, 0)};
  for (std::size_t i = 0; i < sorted.size() && sorted[i] <= end; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(sorted.size());
    steps.push_back(axes.At(sorted[i], share));
    steps.push_back(axes.At(sorted[i], share + 1.0 / static_cast<double>(sorted.size())));
  }
  canvas.Polyline(steps, kBlue, 2);
  canvas.Polyline(Curve(axes, end, [&](double x) { return Cdf(model, x); }), kRed, 1.6);
  axes.Legend({{"training", kBlue}, {FitText(model), kRed}}, LegendPlace::kLowerRight);
  return canvas.Finish();
}

}  // namespace homing::client
