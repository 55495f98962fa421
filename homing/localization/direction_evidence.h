// The direction in which the robot drives along the route, by the sign of the flow.
#ifndef HOMING_LOCALIZATION_DIRECTION_EVIDENCE_H_
#define HOMING_LOCALIZATION_DIRECTION_EVIDENCE_H_

#include <array>

#include "homing/profile/profile_views.h"
#include "homing/profile/route_scale.h"

namespace homing {

// Factors of the motion towards home (0) and away from it (1), positive; both 1 without evidence.
// In a turn two opposite cameras contradict each other, and their factors cancel. `weight`: that of
// the observation, (0, 1].
std::array<double, 2> DirectionFactors(const RouteScale& route, const SeenProfiles& profiles,
                                       double weight);

}  // namespace homing

#endif  // HOMING_LOCALIZATION_DIRECTION_EVIDENCE_H_
