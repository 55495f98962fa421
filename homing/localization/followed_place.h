// Notices that the believed place has moved along the map as the robot has, without a break, since
// the robot was surely on its route. On a foreign route the belief jumps from one similar place to
// the next.
#ifndef HOMING_LOCALIZATION_FOLLOWED_PLACE_H_
#define HOMING_LOCALIZATION_FOLLOWED_PLACE_H_

#include "homing/localization/place_jump.h"

namespace homing {

// Not thread-safe.
class FollowedPlace {
 public:
  // Processes one observation. `moved`: steps since the one before, either sign. `is_sure`: the
  // robot is surely on its route. True: the place is followed. Following begins when `is_sure`.
  bool Update(const BelievedPlace& place, double moved, double correlation_steps, bool is_sure);

 private:
  BelievedPlace last_;
  bool is_followed_ = false;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_FOLLOWED_PLACE_H_
