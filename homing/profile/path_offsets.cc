#include "homing/profile/path_offsets.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace homing {
namespace {

// Standard deviation of the offset before anything was seen, and the probability that the offset
// changes at an observation.
constexpr double kOffsetDeviation = 0.2;
constexpr double kOffsetChange = 0.05;

double SumOf(const OffsetValues& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

// Mass times fit of each offset. An offset that was not tried gets the mean fit of the tried ones.
OffsetValues MassThatFits(const OffsetValues& believed, const OffsetValues& fit,
                          const std::array<bool, kPathOffsets.size()>& tried) {
  OffsetValues mass{};
  double weight = 0;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    if (tried[i]) {
      mass[i] = believed[i] * fit[i];
      weight += believed[i];
    }
  }
  const double mean = SumOf(mass) / weight;
  for (std::size_t i = 0; i < mass.size(); ++i) {
    if (!tried[i]) mass[i] = believed[i] * mean;
  }
  return mass;
}

}  // namespace

const OffsetValues& PathOffsets::Prior() {
  static const auto prior = [] {
    OffsetValues all{};
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i] = std::exp(-0.5 * std::pow(kPathOffsets[i] / kOffsetDeviation, 2));
    }
    const double sum = SumOf(all);
    for (double& value : all) {
      value /= sum;
    }
    return all;
  }();
  return prior;
}

OffsetValues PathOffsets::Mix(const OffsetValues& mass) {
  const double sum = SumOf(mass);
  if (!(sum > 0)) {
    return Prior();
  }
  OffsetValues mixed;
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    mixed[i] = (1 - kOffsetChange) * mass[i] / sum + kOffsetChange * Prior()[i];
  }
  return mixed;
}

void PathOffsets::Grow(std::int64_t step_count) {
  stretches_.resize(StretchesOf(step_count), Prior());
}

// The robot moves by at most one stretch an observation.
OffsetValues PathOffsets::Learn(std::size_t first, std::span<const OffsetValues> fits,
                                const std::array<bool, kPathOffsets.size()>& tried) {
  OffsetValues all{};
  // Mass in each stretch where the robot may be next, beginning with the stretch before `first`.
  std::vector<OffsetValues> about(fits.size() + 2, OffsetValues{});
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const OffsetValues mass = MassThatFits(stretches_[first + i], fits[i], tried);
    for (std::size_t offset = 0; offset < mass.size(); ++offset) {
      all[offset] += mass[offset];
      for (std::size_t next = 0; next < 3; ++next) {
        about[i + next][offset] += mass[offset];
      }
    }
  }
  std::ranges::fill(stretches_, Prior());
  for (std::size_t i = first == 0 ? 1 : 0; i < about.size(); ++i) {
    const std::size_t stretch = first + i - 1;
    if (stretch < stretches_.size()) stretches_[stretch] = Mix(about[i]);
  }
  return all;
}

}  // namespace homing
