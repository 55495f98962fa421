// Notices that the believed place is one that the robot cannot have reached. On its route a robot
// moves along the map; on a foreign route the belief jumps from one similar place to the next.
#ifndef HOMING_LOCALIZATION_PLACE_JUMP_H_
#define HOMING_LOCALIZATION_PLACE_JUMP_H_

#include <cstddef>
#include <cstdint>

namespace homing {

// The likeliest place after an observation.
struct BelievedPlace {
  std::size_t journey = 0;
  std::int64_t step = 0;
  // Probability of the place among all steps. 0..1.
  double mass = 0;
};

// The map of the likeliest place.
struct MapLength {
  std::int64_t steps = 0;
  // Lag at which the similarity of neighbours has halved, steps. At least 1.
  double correlation_steps = 1;
};

// Not thread-safe.
class PlaceJump {
 public:
  // Processes one observation. `moved`: steps since the one before, either sign. True: the place is
  // far from the last settled place of this journey, further than the robot can have moved since. A
  // map may be a loop, so the two ends count as neighbours. Several journeys may lead along one
  // road, so a change of journey is no jump.
  bool Update(const BelievedPlace& place, double moved, const MapLength& map);

 private:
  // The last place that was settled; its mass is 0 before the first.
  BelievedPlace settled_;
  // Steps moved since.
  double moved_ = 0;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_PLACE_JUMP_H_
