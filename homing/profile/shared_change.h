// Measures whether the view changes along the way as the map does. This is evidence of being on the
// route that neither light nor the camera nor an unspecific landmark can imitate. See
// docs/algorithm.md.
#ifndef HOMING_PROFILE_SHARED_CHANGE_H_
#define HOMING_PROFILE_SHARED_CHANGE_H_

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>

#include "homing/journey/journey_ref.h"
#include "homing/landmark/flow_profile.h"
#include "homing/profile/profile_distance.h"
#include "homing/profile/route_scale.h"

namespace homing {

// The views of one instant, and the robot's believed place at that instant.
struct BelievedInstant {
  std::size_t journey = 0;
  std::int64_t step = 0;
  // Indexed by side of the route; the view of the likeliest path offset. None where no camera
  // looked.
  struct Seen {
    FlowProfile profile;
    const CellMask* covered = nullptr;
  };
  std::array<std::optional<Seen>, 2> seen{};
  // Steps moved since the first instant; the sign gives the direction.
  double moved = 0;
};

// Keeps the instants of the last stretch. Not thread-safe.
class SharedChange {
 public:
  // Adds an instant. Compares the change of the view with that of the map since the instant some
  // correlation lengths before. Returns the fraction of the map's usual change that both share,
  // less the fraction that the most similar different place of the same map shares: above 0 on the
  // route. None while the robot has not moved that far. `routes`: the scales of `journeys`.
  std::optional<double> Add(std::span<const JourneyRef> journeys, const RouteScale& route,
                            const BelievedInstant& now);

 private:
  std::deque<BelievedInstant> past_;
};

}  // namespace homing

#endif  // HOMING_PROFILE_SHARED_CHANGE_H_
