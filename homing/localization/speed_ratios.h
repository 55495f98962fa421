// The odometer's ratio at each step: the present flow over the stored flow.
#ifndef HOMING_LOCALIZATION_SPEED_RATIOS_H_
#define HOMING_LOCALIZATION_SPEED_RATIOS_H_

#include <cstdint>
#include <vector>

#include "homing/profile/profile_views.h"
#include "homing/profile/route_scale.h"
#include "homing/profile/step_mass.h"

namespace homing {

// Indices into SpeedEvidence, by step of `window`; the mean of the cameras.
std::vector<std::int16_t> SpeedRatios(const RouteScale& route, const StepMass& window,
                                      const SeenProfiles& profiles);

}  // namespace homing

#endif  // HOMING_LOCALIZATION_SPEED_RATIOS_H_
