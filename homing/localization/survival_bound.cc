#include "homing/localization/survival_bound.h"

#include <cmath>

namespace homing {
namespace {

// Covers the rounding of float, twice over.
constexpr double kBoundRounding = 1e-6;

}  // namespace

SurvivalBound::SurvivalBound(const DeviationModel& model) : table_{} {
  table_[0] = 1;
  for (std::int32_t i = 1; i < kEntries; ++i) {
    const double least = std::bit_cast<float>((kFirst + i) << kShift);
    const double survival = Survival(model, std::sqrt(least * (1 - kBoundRounding)));
    table_[static_cast<std::size_t>(i)] =
        static_cast<float>(std::min(1.0, survival * (1 + kBoundRounding)));
  }
}

}  // namespace homing
