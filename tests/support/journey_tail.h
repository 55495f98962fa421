// The tail of a map, which a store reads without the map.
#ifndef TESTS_SUPPORT_JOURNEY_TAIL_H_
#define TESTS_SUPPORT_JOURNEY_TAIL_H_

#include "homing/journey/journey_recorder.h"

namespace homing::test {

// Steps without fingerprints are left out.
inline JourneyTail TailOf(const JourneyMap& map) {
  JourneyTail tail{map.step_count(),
                   static_cast<std::int32_t>(map.landmarks().size()),
                   map.step_count() == 0 ? -1 : map.sequence(map.step_count() - 1),
                   {}};
  for (std::int64_t number = FirstTailStep(map.settings(), map.step_count());
       number < map.step_count(); ++number) {
    JourneyStep step;
    step.step = number;
    for (const Fingerprint& fingerprint : map.fingerprints(number)) {
      step.fingerprints.push_back({map.side_of(fingerprint), fingerprint, 0});
    }
    if (!step.fingerprints.empty()) tail.steps.push_back(step);
  }
  return tail;
}

}  // namespace homing::test

#endif  // TESTS_SUPPORT_JOURNEY_TAIL_H_
