// The masses of a RouteBelief: by step, by direction, and in all.
#include <algorithm>
#include <span>

#include "homing/localization/lane_loops.h"
#include "homing/localization/route_belief.h"

namespace homing {

StepMass RouteBelief::Masses() const {
  StepMass masses{first_, ways_[0]};
  AddLane(ways_[1], masses.mass);
  for (float& mass : masses.mass) {
    mass *= static_cast<float>(scale_);
  }
  return masses;
}

double RouteBelief::MassWithin() const { return scale_ * (SumOf(ways_[0]) + SumOf(ways_[1])); }

std::array<double, 2> RouteBelief::DirectionMass(std::int64_t first, std::int64_t last) const {
  const std::int64_t begin = std::max<std::int64_t>(0, first - first_);
  const std::int64_t end = std::min(focus_size(), last + 1 - first_);
  if (begin >= end) return {};
  std::array<double, 2> mass{};
  for (std::size_t way = 0; way < mass.size(); ++way) {
    mass[way] = scale_ * SumOf(std::span(ways_[way])
                                   .subspan(static_cast<std::size_t>(begin),
                                            static_cast<std::size_t>(end - begin)));
  }
  return mass;
}

double RouteBelief::MassBeyond() const {
  return background_ * scale_ * static_cast<double>(step_count_ - focus_size());
}

double RouteBelief::Mass() const { return MassWithin() + MassBeyond(); }

}  // namespace homing
