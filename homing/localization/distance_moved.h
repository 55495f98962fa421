// How far the robot moves from observation to observation, by the odometer alone: what its evidence
// is weighed by.
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

// What an observation may say that the ones before have not, after so many steps on a map with this
// correlation length. (0, 1].
double EvidenceWeight(double moved, double correlation_steps);

// The ratio of one observation scatters, and the speeds that the filter believes in have a prior.
// So this compares the readings of the last few observations with those of the map about where
// the robot may be. Not thread-safe.
class DistanceMoved {
 public:
  // Steps of this observation, -8 to 8. Negative: the other way past what is seen. `masses`: by
  // journey, where the robot may be. None without a reading.
  std::optional<double> Update(std::span<const RouteScale> routes, std::span<const StepMass> masses,
                               const SeenProfiles& profiles);

 private:
  // By journey and side.
  std::vector<std::array<std::optional<double>, 2>> usual_;
  // As it has been lately, -1 to 1.
  double way_ = 0;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_DISTANCE_MOVED_H_
