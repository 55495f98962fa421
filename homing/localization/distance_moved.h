// The distance that the robot moves between observations, by the odometer alone. It determines the
// weight of an observation's evidence.
#ifndef HOMING_LOCALIZATION_DISTANCE_MOVED_H_
#define HOMING_LOCALIZATION_DISTANCE_MOVED_H_

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "homing/journey/journey_ref.h"
#include "homing/profile/profile_views.h"
#include "homing/profile/route_scale.h"
#include "homing/profile/step_mass.h"

namespace homing {

// Weight of an observation that is `moved` steps after the previous one, on a map with this
// correlation length: the fraction of it that is new. (0, 1].
double EvidenceWeight(double moved, double correlation_steps);

// The ratio of a single observation scatters, and the filter's speeds contain a prior. So this
// compares the readings of the last few observations with those of the map around the robot's
// possible places. Not thread-safe.
class DistanceMoved {
 public:
  // Steps moved with this observation, -8 to 8. Negative: the scene passes in the other direction.
  // `masses`: by journey, the robot's possible places. None without a reading.
  std::optional<double> Update(Routes routes, std::span<const StepMass> masses,
                               const SeenProfiles& profiles);

 private:
  // Mean reading of the last observations, by journey and side.
  std::vector<std::array<std::optional<double>, 2>> usual_;
  // Mean direction of the last observations, -1 to 1.
  double way_ = 0;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_DISTANCE_MOVED_H_
