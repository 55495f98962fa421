#include "homing/matching/survival_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace homing {
namespace {

// Twice the rounding error of float.
constexpr double kBoundRounding = 1e-6;
// Smaller bounds, times a ratio of numbers, would not be exact in float.
constexpr double kLeastBound = 1e-25;

}  // namespace

SurvivalBound::SurvivalBound(const DeviationModel& model) : table_{}, least_{} {
  table_[0] = 1;
  // The last step has no upper end: its lower bound stays 0.
  for (std::int32_t i = 1; i < kEntries; ++i) {
    const double squared = std::bit_cast<float>((kFirst + i) << kShift);
    const double nearer = Survival(model, std::sqrt(squared * (1 - kBoundRounding)));
    table_[static_cast<std::size_t>(i)] =
        static_cast<float>(std::clamp(nearer * (1 + kBoundRounding), kLeastBound, 1.0));
    const double further = Survival(model, std::sqrt(squared * (1 + kBoundRounding)));
    least_[static_cast<std::size_t>(i - 1)] =
        further < kLeastBound ? 0 : static_cast<float>(further * (1 - kBoundRounding));
  }
}

float SurvivalBound::ReachOf(double probability) const {
  const auto beyond = std::ranges::partition_point(
      table_, [probability](float most) { return double{most} >= probability; });
  return beyond == table_.end()
             ? std::numeric_limits<float>::infinity()
             : std::bit_cast<float>((kFirst + static_cast<std::int32_t>(beyond - table_.begin()))
                                    << kShift);
}

}  // namespace homing
