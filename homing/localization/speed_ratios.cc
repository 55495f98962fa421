#include "homing/localization/speed_ratios.h"

#include "homing/localization/speed_evidence.h"

namespace homing {

std::vector<std::int16_t> SpeedRatios(const JourneyMap& map, const RouteScale& route,
                                      const StepMass& window, const SeenProfiles& profiles) {
  std::vector<std::int32_t> sums(window.mass.size());
  std::vector<std::int32_t> counts(window.mass.size());
  for (std::size_t side = 0; side < profiles.size(); ++side) {
    const auto stored = map.profiles(Side{static_cast<int>(side)});
    if (!profiles[side] || stored.empty()) continue;
    const CameraOdometer& odometer = route.sides[side]->odometer;
    const std::int16_t now = odometer.Read(profiles[side]->odometer());
    if (now == CameraOdometer::kNone) continue;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const auto step = static_cast<std::size_t>(window.first) + i;
      const std::int16_t then = odometer.Read(stored[step].odometer);
      if (then == CameraOdometer::kNone) continue;
      sums[i] += now - then;
      counts[i] += 1;
    }
  }
  std::vector<std::int16_t> ratios(sums.size(), SpeedEvidence::kNoRatio);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (counts[i] > 0) ratios[i] = SpeedEvidence::IndexOf(sums[i] / counts[i]);
  }
  return ratios;
}

}  // namespace homing
