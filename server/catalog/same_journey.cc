#include "server/catalog/same_journey.h"

#include <algorithm>

namespace homing::server {
namespace {

// The first observation sets image sizes that the request left open. Such a difference is not a
// difference of settings.
JourneySettings WithSizesOf(JourneySettings settings, const JourneySettings& known) {
  for (std::size_t side = 0; side < settings.cameras.size(); ++side) {
    if (settings.cameras[side].width == 0 && settings.cameras[side].height == 0) {
      settings.cameras[side].width = known.cameras[side].width;
      settings.cameras[side].height = known.cameras[side].height;
    }
  }
  return settings;
}

}  // namespace

bool IsSameJourney(const storage::JourneyRecord& wanted, const storage::JourneyRecord& present) {
  return present.state == storage::JourneyState::kActive && !wanted.writer_id.empty() &&
         wanted.writer_id == present.writer_id &&
         std::ranges::is_permutation(wanted.readers, present.readers) &&
         WithSizesOf(wanted.settings, present.settings) == present.settings;
}

}  // namespace homing::server
