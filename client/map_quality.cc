#include "client/map_quality.h"

#include "absl/strings/str_cat.h"

namespace homing::client {
namespace {

// A camera that looks across the route gives about one fingerprint a step.
constexpr std::int64_t kStepsPerFingerprint = 10;

}  // namespace

MapQuality::MapQuality(const v1::Journey& journey) {
  const std::int64_t steps = journey.step_count();
  const std::int64_t fingerprints = journey.fingerprint_count();
  if (steps == 0) {
    reason = "it has no step: the frames do not differ";
  } else if (fingerprints == 0) {
    reason =
        "it has no fingerprint, so no robot can find its place on it; the frames hardly differ (at "
        "a low speed take fewer with --every N), or the camera sees too little that is near";
  } else if (fingerprints * kStepsPerFingerprint < steps) {
    reason = absl::StrCat("only ", fingerprints, " fingerprints in ", steps,
                          " steps; at a low speed take fewer frames with --every N");
  }
  good = reason.empty();
}

std::string MapQuality::Text() const { return good ? "GOOD" : absl::StrCat("POOR: ", reason); }

}  // namespace homing::client
