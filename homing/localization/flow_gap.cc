#include "homing/localization/flow_gap.h"

#include <algorithm>

namespace homing {
namespace {

// A gap leaves less than this part of the vectors, mean of the sides: of those that move as before,
// and of others.
constexpr double kLeastCoherent = 0.35;
constexpr double kLeastPart = 0.5;
// Weight of an observation in the usual number of vectors: also of one after a gap, since the
// scene may have become poorer.
constexpr double kLastShare = 0.3;
constexpr double kGapShare = 0.1;

bool RightExceedsLeft(const SeenProfiles& profiles) {
  return profiles[1]->odometer().median_x > profiles[0]->odometer().median_x;
}

}  // namespace

bool FlowGap::IsCoherent(const SeenProfiles& profiles) const {
  const OdometerReading& left = profiles[0]->odometer();
  const OdometerReading& right = profiles[1]->odometer();
  return left.has_value() && right.has_value() && (left.median_x > 0) != (right.median_x > 0) &&
         (!is_known_ || RightExceedsLeft(profiles) == is_positive_);
}

bool FlowGap::Update(const SeenProfiles& profiles) {
  if (!profiles[0] || !profiles[1]) return false;
  double part = 0;
  for (std::size_t side = 0; side < usual_.size(); ++side) {
    const auto seen = static_cast<double>(profiles[side]->size());
    if (!is_known_) usual_[side] = seen;
    part += 0.5 * std::min(1.0, seen / std::max(1.0, usual_[side]));
  }
  const bool is_gap = part < (IsCoherent(profiles) ? kLeastCoherent : kLeastPart);
  for (std::size_t side = 0; side < usual_.size(); ++side) {
    const auto seen = static_cast<double>(profiles[side]->size());
    usual_[side] += (is_gap ? kGapShare : kLastShare) * (seen - usual_[side]);
  }
  if (!is_gap) {
    is_known_ = true;
    is_positive_ = RightExceedsLeft(profiles);
  }
  return is_gap;
}

}  // namespace homing
