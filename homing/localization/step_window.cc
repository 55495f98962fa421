#include "homing/localization/step_window.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace homing {
namespace {

// Where the mass is narrow, many windows hold nearly all of it. Windows that hold this much less
// than the best one count as equal.
constexpr double kSlack = 0.002;

// Sums of the mass below each step of the active window.
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

}  // namespace

StepWindow BestWindow(const StepMass& mass, std::int64_t half, std::int64_t step_count) {
  const MassBelow below(mass);
  const auto around = [&](std::int64_t step) {
    StepWindow window = WindowAround(step, half, step_count);
    window.mass = below.Within(window.first, window.last);
    return window;
  };
  const std::int64_t end = mass.first + std::ssize(mass.mass);
  StepWindow best;
  for (std::int64_t step = mass.first; step < end; ++step) {
    const StepWindow window = around(step);
    if (window.mass > best.mass) best = window;
  }
  if (!(best.mass > 0)) return best;
  double sum = 0;
  for (std::int64_t step = std::max(best.first, mass.first); step <= best.last && step < end;
       ++step) {
    sum +=
        double{mass.mass[static_cast<std::size_t>(step - mass.first)]} * static_cast<double>(step);
  }
  const std::int64_t middle = std::lround(sum / best.mass);
  const double least = best.mass - kSlack;
  while (best.step != middle) {
    const StepWindow nearer = around(best.step + (middle < best.step ? -1 : 1));
    if (nearer.mass < least) break;
    best = nearer;
  }
  return best;
}

}  // namespace homing
