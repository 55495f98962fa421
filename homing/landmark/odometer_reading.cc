#include "homing/landmark/odometer_reading.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "homing/flow/median.h"

namespace homing {
namespace {

// Avoids a division by zero for vectors at the median midpoint. Image widths squared.
constexpr float kLeastSquare = 1e-4F;

std::int16_t SignedCode(double px) {
  constexpr double kMost = std::numeric_limits<std::int16_t>::max();
  return static_cast<std::int16_t>(
      std::clamp(std::round(px * OdometerReading::kSignedPerPx), -kMost, kMost));
}

std::uint8_t LengthCode(double px) {
  const double octaves = std::log2(std::max(px, 1e-6)) - OdometerReading::kLeastLog2Px;
  const double code = 1 + std::round(octaves * OdometerReading::kCodesPerOctave);
  return static_cast<std::uint8_t>(std::clamp(code, 1.0, 255.0));
}

// Displacements of the finite vectors, pixels, and their midpoints in image widths.
struct Motions {
  std::vector<float> x;
  std::vector<float> y;
  std::vector<float> at_x;
  std::vector<float> at_y;
};

Motions MotionsOf(const FlowField& field) {
  Motions motions;
  for (auto* of : {&motions.x, &motions.y, &motions.at_x, &motions.at_y}) {
    of->reserve(field.vectors.size());
  }
  const float per_width = 1 / static_cast<float>(field.width);
  for (const FlowVector& v : field.vectors) {
    const float x = v.end_x - v.start_x;
    const float y = v.end_y - v.start_y;
    if (!std::isfinite(x) || !std::isfinite(y)) continue;
    motions.x.push_back(x);
    motions.y.push_back(y);
    motions.at_x.push_back(0.5F * (v.start_x + v.end_x) * per_width);
    motions.at_y.push_back(0.5F * (v.start_y + v.end_y) * per_width);
  }
  return motions;
}

}  // namespace

std::int16_t OdometerReading::TurnCode(double turn) {
  constexpr double kMost = std::numeric_limits<std::int16_t>::max();
  const double code = std::clamp(std::round(turn * kTurnPerRad), -kMost, kMost);
  return code == 0 ? std::int16_t{1} : static_cast<std::int16_t>(code);
}

std::optional<double> OdometerReading::turn() const {
  if (turn_code == 0) return std::nullopt;
  return turn_code / kTurnPerRad;
}

std::optional<std::int16_t> ReadMedianX(const FlowField& field) {
  const Motions motions = MotionsOf(field);
  if (motions.x.size() < OdometerReading::kLeastVectors) return std::nullopt;
  return SignedCode(Median(motions.x));
}

OdometerReading ReadOdometer(const FlowField& field) {
  const Motions motions = MotionsOf(field);
  const std::size_t count = motions.x.size();
  if (count < OdometerReading::kLeastVectors) {
    return {};
  }
  const float median_x = Median(motions.x), median_y = Median(motions.y);
  const float middle_x = Median(motions.at_x), middle_y = Median(motions.at_y);
  std::vector<float> lengths(count), spreads(count), expansions(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float x = motions.x[i], y = motions.y[i];
    const float dx = x - median_x, dy = y - median_y;
    const float at_x = motions.at_x[i] - middle_x, at_y = motions.at_y[i] - middle_y;
    lengths[i] = std::sqrt(x * x + y * y);
    spreads[i] = std::sqrt(dx * dx + dy * dy);
    expansions[i] = (dx * at_x + dy * at_y) / (at_x * at_x + at_y * at_y + kLeastSquare);
  }
  return {.median_x = SignedCode(median_x),
          .expansion = SignedCode(Median(expansions)),
          .length_code = LengthCode(Median(lengths)),
          .spread_code = LengthCode(Median(spreads)),
          .turn_code = 0};
}

}  // namespace homing
