// Journey files of any length.
#ifndef TESTS_SUPPORT_JOURNEY_FILE_H_
#define TESTS_SUPPORT_JOURNEY_FILE_H_

#include <cstdint>
#include <string>

#include "homing/v1/homing_service.pb.h"
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

// A query with 200 fingerprints that are similar to all of such a file.
inline v1::MatchLandmarksRequest ManyFingerprints(const std::string& journey) {
  v1::MatchLandmarksRequest request;
  request.set_journey(journey);
  request.set_travel(v1::TRAVEL_SAME);
  request.set_threshold(0);
  request.set_max_matches(1000);
  for (v1::MatchView* view : {request.mutable_left(), request.mutable_right()}) {
    for (int i = 0; i < 100; ++i) {
      v1::Fingerprint* const seen = view->mutable_fingerprints()->add_fingerprints();
      seen->set_x(101 + static_cast<float>(i) / 40);
      seen->set_y(81);
      seen->set_count(40);
    }
  }
  return request;
}

}  // namespace homing::test

#endif  // TESTS_SUPPORT_JOURNEY_FILE_H_
