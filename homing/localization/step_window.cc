#include "homing/localization/step_window.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace homing {
namespace {

// Sums of the mass below each step of the focus.
class MassBelow {
 public:
  explicit MassBelow(const StepMass& mass) : first_(mass.first), below_(mass.mass.size() + 1) {
    for (std::size_t i = 0; i < mass.mass.size(); ++i) {
      below_[i + 1] = below_[i] + double{mass.mass[i]};
    }
  }

  // From `first` to `last`, inclusive.
  double Within(std::int64_t first, std::int64_t last) const {
    return below_[Index(last + 1)] - below_[Index(first)];
  }

 private:
  std::size_t Index(std::int64_t step) const {
    return static_cast<std::size_t>(
        std::clamp<std::int64_t>(step - first_, 0, std::ssize(below_) - 1));
  }

  std::int64_t first_;
  std::vector<double> below_;
};

StepWindow WindowAround(std::int64_t step, std::int64_t half, std::int64_t step_count) {
  return {.step = step,
          .first = std::max<std::int64_t>(0, step - half),
          .last = std::min(step_count - 1, step + half),
          .mass = 0};
}

// The mean step of the mass within the window.
std::int64_t MeanStep(const StepMass& mass, const StepWindow& window) {
  const std::int64_t end = mass.first + std::ssize(mass.mass);
  const std::int64_t begin = std::max(window.first, mass.first);
  double moment = 0;
  for (std::int64_t s = begin; s <= std::min(window.last, end - 1); ++s) {
    moment += static_cast<double>(s - begin) *
              double{mass.mass[static_cast<std::size_t>(s - mass.first)]};
  }
  return begin + std::llround(moment / window.mass);
}

}  // namespace

StepWindow BestWindow(const StepMass& mass, std::int64_t half, std::int64_t step_count) {
  const MassBelow below(mass);
  StepWindow best;
  for (std::int64_t s = mass.first; s < mass.first + std::ssize(mass.mass); ++s) {
    StepWindow window = WindowAround(s, half, step_count);
    window.mass = below.Within(window.first, window.last);
    if (window.mass > best.mass) {
      best = window;
    }
  }
  if (best.mass > 0) {
    best = WindowAround(MeanStep(mass, best), half, step_count);
    best.mass = below.Within(best.first, best.last);
  }
  return best;
}

}  // namespace homing
