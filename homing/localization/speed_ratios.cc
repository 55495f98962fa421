#include "homing/localization/speed_ratios.h"

#include "homing/localization/speed_evidence.h"

namespace homing {

std::vector<std::int16_t> SpeedRatios(const RouteScale& route, const StepMass& window,
                                      const SeenProfiles& profiles) {
  std::vector<std::int32_t> sums(window.mass.size());
  std::vector<std::int32_t> counts(window.mass.size());
  for (std::size_t side = 0; side < profiles.size(); ++side) {
    if (!profiles[side] || !route.sides[side]) continue;
    const CameraOdometer& odometer = route.sides[side]->odometer;
    const std::int16_t now = odometer.Read(profiles[side]->odometer());
    if (now == CameraOdometer::kNone) continue;
    const std::int16_t* const then =
        route.sides[side]->readings.data() + static_cast<std::size_t>(window.first);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const bool has_reading = then[i] != CameraOdometer::kNone;
      sums[i] += has_reading ? now - then[i] : 0;
      counts[i] += has_reading ? 1 : 0;
    }
  }
  std::vector<std::int16_t> ratios(sums.size(), SpeedEvidence::kNoRatio);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (counts[i] > 0) ratios[i] = SpeedEvidence::IndexOf(sums[i] / counts[i]);
  }
  return ratios;
}

}  // namespace homing
