// How much of the change along one stretch of a map another stretch of the same map has too: what
// a robot on a foreign route of the same kind would share with the map by chance.
#ifndef HOMING_PROFILE_DIFFERENT_SHARE_H_
#define HOMING_PROFILE_DIFFERENT_SHARE_H_

#include "homing/profile/route_scale.h"

namespace homing {

// Fills in different_share. REQUIRES: all else of `route` is measured.
void MeasureDifferentShare(const JourneyMap& map, RouteScale& route);

}  // namespace homing

#endif  // HOMING_PROFILE_DIFFERENT_SHARE_H_
