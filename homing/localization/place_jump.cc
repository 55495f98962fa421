#include "homing/localization/place_jump.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace homing {
namespace {

// A place with this mass is settled; one with kElsewhere is believed.
constexpr double kSettled = 0.7;
constexpr double kElsewhere = 0.5;
// A place as near as this is none that only looks alike: a lag of the belief is made good by such a
// step. Correlation lengths.
constexpr double kNearLengths = 8;
// The odometer reads too little where an object has gone that was near the camera.
constexpr double kMostOfReading = 2;

}  // namespace

bool PlaceJump::Update(const BelievedPlace& place, double moved, const MapLength& map) {
  moved_ += std::abs(moved);
  bool is_far = false;
  if (settled_.mass > 0 && settled_.journey == place.journey && place.mass >= kElsewhere) {
    const std::int64_t apart = std::abs(place.step - settled_.step);
    const auto nearest = static_cast<double>(std::min(apart, map.steps - apart));
    is_far = nearest > kNearLengths * map.correlation_steps + kMostOfReading * moved_;
  }
  if (place.mass >= kSettled) {
    settled_ = place;
    moved_ = 0;
  }
  return is_far;
}

}  // namespace homing
