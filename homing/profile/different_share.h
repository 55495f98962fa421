// Measures which fraction of the change along one stretch of a map recurs along another stretch of
// the same map. A robot on a foreign route of the same kind would share about as much by chance.
#ifndef HOMING_PROFILE_DIFFERENT_SHARE_H_
#define HOMING_PROFILE_DIFFERENT_SHARE_H_

#include "homing/profile/route_scale.h"

namespace homing {

// Fills in route.different_share. REQUIRES: all other members of `route` are measured.
void MeasureDifferentShare(const JourneyMap& map, RouteScale& route);

}  // namespace homing

#endif  // HOMING_PROFILE_DIFFERENT_SHARE_H_
