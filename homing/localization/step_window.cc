#include "homing/localization/step_window.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace homing {
namespace {

// Where the mass is narrow many windows hold all of it: what its middle step adds to a window.
constexpr double kOfMiddle = 1e-3;

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

}  // namespace

StepWindow BestWindow(const StepMass& mass, std::int64_t half, std::int64_t step_count) {
  const MassBelow below(mass);
  StepWindow best;
  double best_score = 0;
  for (std::int64_t s = mass.first; s < mass.first + std::ssize(mass.mass); ++s) {
    StepWindow window = WindowAround(s, half, step_count);
    window.mass = below.Within(window.first, window.last);
    const double score =
        window.mass + kOfMiddle * double{mass.mass[static_cast<std::size_t>(s - mass.first)]};
    if (score > best_score) {
      best_score = score;
      best = window;
    }
  }
  return best;
}

}  // namespace homing
