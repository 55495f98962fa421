// The interval of steps that holds the most mass of a belief.
#ifndef HOMING_LOCALIZATION_STEP_WINDOW_H_
#define HOMING_LOCALIZATION_STEP_WINDOW_H_

#include <cstdint>

#include "homing/localization/route_belief.h"

namespace homing {

// `step` +- a half width, cut at the ends of the journey, inclusive.
struct StepWindow {
  std::int64_t step = 0;
  std::int64_t first = 0;
  std::int64_t last = 0;
  // Below 0: no window.
  double mass = -1;
};

// The window of the greatest mass; of windows that hold nearly as much, the one around the middle
// of that mass. No window without steps. `half` >= 0. `step_count`: that of the journey, which has
// no mass outside of `mass`.
StepWindow BestWindow(const StepMass& mass, std::int64_t half, std::int64_t step_count);

}  // namespace homing

#endif  // HOMING_LOCALIZATION_STEP_WINDOW_H_
