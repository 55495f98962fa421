#include "homing/localization/distance_moved.h"

#include <algorithm>
#include <cmath>

namespace homing {
namespace {

// Weight of the last reading in the usual one.
constexpr double kLastReading = 0.3;
// The filter's fastest speed.
constexpr double kMostMoved = 8;
// Evidence of an observation: steps moved over correlation length, times this.
constexpr double kEvidencePerLength = 1.5;
constexpr double kLeastEvidence = 0.01;

double MeanReading(std::span<const std::int16_t> readings, const StepMass& mass) {
  double sum = 0;
  for (std::size_t i = 0; i < mass.mass.size(); ++i) {
    sum += double{mass.mass[i]} * readings[static_cast<std::size_t>(mass.first) + i];
  }
  return sum;
}

}  // namespace

double EvidenceWeight(double moved, double correlation_steps) {
  return std::clamp(kEvidencePerLength * std::abs(moved) / correlation_steps, kLeastEvidence, 1.0);
}

std::optional<double> DistanceMoved::Update(Routes routes, std::span<const StepMass> masses,
                                            const SeenProfiles& profiles) {
  usual_.resize(routes.size());
  double sum = 0, all = 0, way = 0;
  for (std::size_t i = 0; i < routes.size(); ++i) {
    const double mass = masses[i].Sum();
    for (std::size_t side = 0; side < profiles.size(); ++side) {
      if (!routes[i]->sides[side] || !profiles[side]) continue;
      const std::int16_t now = routes[i]->sides[side]->odometer.Read(profiles[side]->odometer());
      if (now == CameraOdometer::kNone) continue;
      std::optional<double>& usual = usual_[i][side];
      usual = usual ? *usual + kLastReading * (now - *usual) : now;
      sum += *usual * mass - MeanReading(routes[i]->sides[side]->usual_readings, masses[i]);
      all += mass;
      way += mass * routes[i]->sides[side]->odometer.Way(profiles[side]->odometer());
    }
  }
  if (!(all > 0)) {
    return std::nullopt;
  }
  const double moved = std::min(kMostMoved, std::exp2(sum / all / CameraOdometer::kPerOctave));
  way_ += kLastReading * (way / all - way_);
  return way_ < 0 ? -moved : moved;
}

}  // namespace homing
