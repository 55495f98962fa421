// Journey files of any length.
#ifndef TESTS_SUPPORT_JOURNEY_FILE_H_
#define TESTS_SUPPORT_JOURNEY_FILE_H_

#include <cstdint>
#include <string>

#include "server/service/journey_archive.h"

namespace homing::test {

// `per_side` fingerprints a side and step, all at about the same place; empty if the map refuses
// them.
inline std::string JourneyFile(std::int64_t steps, int per_side) {
  JourneyMap map((JourneySettings()));
  for (std::int64_t i = 0; i < steps; ++i) {
    JourneyStep step{.step = i, .motion = Motion::kMoving, .fingerprints = {}, .profiles = {}};
    for (const Side side : {Side::kLeft, Side::kRight}) {
      for (int n = 0; n < per_side; ++n) {
        const auto landmark = static_cast<std::int32_t>(step.fingerprints.size());
        const float x = 100.5F + static_cast<float>(i % 97) / 20;
        step.fingerprints.push_back({side, {x, 80.25F, 40, landmark}, 0.25});
      }
    }
    if (!map.Append(step).ok()) return "";
  }
  return server::EncodeJourney({}, map).value_or("");
}

}  // namespace homing::test

#endif  // TESTS_SUPPORT_JOURNEY_FILE_H_
