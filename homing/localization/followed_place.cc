#include "homing/localization/followed_place.h"

#include <cmath>
#include <cstdlib>

namespace homing {
namespace {

// Least mass of a followed place.
constexpr double kFollowed = 0.7;
// Greatest difference between the place's motion and the robot's from one observation to the next,
// correlation lengths.
constexpr double kApartLengths = 3;

}  // namespace

bool FollowedPlace::Update(const BelievedPlace& place, double moved, double correlation_steps,
                           bool is_sure) {
  const auto advanced = static_cast<double>(std::abs(place.step - last_.step));
  const bool is_same = place.journey == last_.journey &&
                       std::abs(advanced - std::abs(moved)) <= kApartLengths * correlation_steps;
  is_followed_ = place.mass >= kFollowed && (is_followed_ ? is_same : is_sure);
  last_ = place;
  return is_followed_;
}

}  // namespace homing
