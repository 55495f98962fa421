// Draws a journey's map as a strip: the landmarks of both sides over the steps, with the number of
// vectors of each fingerprint.
#ifndef CLIENT_PICTURE_JOURNEY_STRIP_H_
#define CLIENT_PICTURE_JOURNEY_STRIP_H_

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "homing/flow/observation.h"
#include "homing/landmark/fingerprint.h"

namespace homing::client {

struct StripFingerprint {
  std::int64_t step = 0;
  Side side = Side::kLeft;
  Fingerprint fingerprint;
};

struct JourneyStrip {
  std::string title;
  std::int64_t step_count = 0;
  std::vector<StripFingerprint> fingerprints;
  // Image size, pixels, by side; 0: not known.
  std::array<int, 2> widths{};
  std::array<int, 2> heights{};
};

// Errors of Canvas.
absl::Status DrawJourneyStrip(const std::string& path, const JourneyStrip& strip);

// Draws one step: means and counts, in the image of each side.
absl::Status DrawJourneyStep(const std::string& path, const JourneyStrip& strip, std::int64_t step);

}  // namespace homing::client

#endif  // CLIENT_PICTURE_JOURNEY_STRIP_H_
