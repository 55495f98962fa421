// A journey that is read, and its name.
#ifndef HOMING_JOURNEY_JOURNEY_REF_H_
#define HOMING_JOURNEY_JOURNEY_REF_H_

#include <string>

#include "homing/journey/journey_map.h"

namespace homing {

// A journey to search. It owns neither the name nor the map; both must outlive it.
struct JourneyRef {
  const std::string* name = nullptr;
  const JourneyMap* map = nullptr;
};

}  // namespace homing

#endif  // HOMING_JOURNEY_JOURNEY_REF_H_
