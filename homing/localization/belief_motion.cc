// How fast the robot moves, and which way, as a RouteBelief has it.
#include <algorithm>
#include <numeric>

#include "homing/localization/route_belief.h"

namespace homing {

RouteBelief::Speed RouteBelief::MeanSpeed() const {
  Speed mean;
  double mass = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const double of_lane = std::accumulate(lanes_[lane].begin(), lanes_[lane].end(), 0.0);
    const double speed = kSpeeds[lane % kSpeedCount];
    mass += of_lane;
    mean.absolute += of_lane * speed;
    mean.outward += of_lane * (lane < kSpeedCount ? -speed : speed);
  }
  if (mass > 0) {
    mean.absolute /= mass;
    mean.outward /= mass;
  }
  return mean;
}

std::array<double, 2> RouteBelief::DirectionMass(std::int64_t first, std::int64_t last) const {
  std::array<double, 2> mass{};
  const std::int64_t begin = std::max<std::int64_t>(0, first - first_);
  const std::int64_t end = std::min(focus_size(), last + 1 - first_);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    for (std::int64_t s = begin; s < end; ++s) {
      mass[lane / kSpeedCount] += scale_ * double{lanes_[lane][static_cast<std::size_t>(s)]};
    }
  }
  return mass;
}

}  // namespace homing
