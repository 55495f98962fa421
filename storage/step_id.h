// The key of a row of `steps`: journey and step in one integer, which keeps a journey's rows
// together and in order.
#ifndef STORAGE_STEP_ID_H_
#define STORAGE_STEP_ID_H_

#include <cstdint>

#include "homing/journey/journey_map.h"

namespace homing::storage {

// The schema uses it too.
inline constexpr int kStepBits = 25;
static_assert(kMostSteps <= std::int64_t{1} << kStepBits);

inline std::int64_t StepId(std::int64_t journey_id, std::int64_t step) {
  return (journey_id << kStepBits) + step;
}

inline std::int64_t StepOfId(std::int64_t step_id) {
  return step_id & ((std::int64_t{1} << kStepBits) - 1);
}

}  // namespace homing::storage

#endif  // STORAGE_STEP_ID_H_
