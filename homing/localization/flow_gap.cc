#include "homing/localization/flow_gap.h"

#include <algorithm>

namespace homing {
namespace {

// After a gap less than this fraction of the usual vectors is left, as a mean of both sides:
// kLeastCoherent if both sides move in the same directions as before, else kLeastPart.
constexpr double kLeastCoherent = 0.35;
constexpr double kLeastPart = 0.5;
// Weight of an observation in the usual number of vectors. An observation after a gap counts too,
// since the scene itself may have fewer vectors from now on.
constexpr double kLastShare = 0.3;
constexpr double kGapShare = 0.1;

}  // namespace

FlowGap::Ways FlowGap::WaysOf(const SeenProfiles& profiles) {
  return {profiles[0]->odometer().median_x > 0, profiles[1]->odometer().median_x > 0};
}

bool FlowGap::Update(const SeenProfiles& profiles) {
  if (!profiles[0] || !profiles[1]) return false;
  double part = 0;
  for (std::size_t side = 0; side < usual_.size(); ++side) {
    const auto seen = static_cast<double>(profiles[side]->size());
    if (!ways_) usual_[side] = seen;
    part += 0.5 * std::min(1.0, seen / std::max(1.0, usual_[side]));
  }
  const Ways ways = WaysOf(profiles);
  const bool is_gap = part < (!ways_ || *ways_ == ways ? kLeastCoherent : kLeastPart);
  for (std::size_t side = 0; side < usual_.size(); ++side) {
    const auto seen = static_cast<double>(profiles[side]->size());
    usual_[side] += (is_gap ? kGapShare : kLastShare) * (seen - usual_[side]);
  }
  if (!is_gap) ways_ = ways;
  return is_gap;
}

}  // namespace homing
