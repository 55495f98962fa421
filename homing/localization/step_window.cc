#include "homing/localization/step_window.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace homing {
namespace {

StepWindow WindowAround(const std::vector<double>& mass, std::int64_t step, std::int64_t half) {
  StepWindow window{.step = step,
                    .first = std::max<std::int64_t>(0, step - half),
                    .last = std::min(std::ssize(mass) - 1, step + half)};
  window.mass = std::accumulate(mass.begin() + window.first, mass.begin() + window.last + 1, 0.0);
  return window;
}

// The mean step of the mass within the window, with the window around it: where the mass is narrow,
// many windows hold all of it.
StepWindow Centred(const std::vector<double>& mass, const StepWindow& window, std::int64_t half) {
  double moment = 0;
  for (std::int64_t s = window.first; s <= window.last; ++s) {
    moment += static_cast<double>(s - window.first) * mass[static_cast<std::size_t>(s)];
  }
  const std::int64_t mean = window.first + std::llround(moment / window.mass);
  return WindowAround(mass, mean, half);
}

}  // namespace

StepWindow BestWindow(const std::vector<double>& mass, std::int64_t half) {
  std::vector<double> below(mass.size() + 1);
  std::partial_sum(mass.begin(), mass.end(), below.begin() + 1);
  StepWindow best;
  for (std::int64_t s = 0; s < std::ssize(mass); ++s) {
    const std::int64_t first = std::max<std::int64_t>(0, s - half);
    const std::int64_t last = std::min(std::ssize(mass) - 1, s + half);
    const double in =
        below[static_cast<std::size_t>(last) + 1] - below[static_cast<std::size_t>(first)];
    if (in > best.mass) {
      best = {.step = s, .first = first, .last = last, .mass = in};
    }
  }
  return best.mass > 0 ? Centred(mass, best, half) : best;
}

}  // namespace homing
