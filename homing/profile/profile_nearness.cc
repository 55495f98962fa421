#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "homing/profile/profile_likelihood.h"

namespace homing {
namespace {

// A robot is on the route if its best distance is below this part of the distance of places one
// correlation length apart.
constexpr double kNearPart = 0.97;
// Unit of Nearness, in distances of different places.
constexpr double kNearnessUnit = 0.1;

}  // namespace

double ProfileLikelihood::NearnessOfSide(std::size_t side, std::size_t journey, std::int64_t first,
                                         std::int64_t last) const {
  const std::size_t offset = LikeliestOffset();
  const std::vector<std::uint16_t>& distances = distances_[side][ViewOf(side, offset)][journey];
  const SideScale& scale = *routes_[journey].sides[side];
  const std::int64_t held = first_steps_[journey];
  std::int32_t best = std::numeric_limits<std::int32_t>::max();
  for (std::int64_t step = std::max(first, held);
       step <= std::min(last, held + std::ssize(distances) - 1); ++step) {
    best = std::min(best, std::int32_t{distances[static_cast<std::size_t>(step - held)]} -
                              std::int32_t{scale.bias[static_cast<std::size_t>(step)]});
  }
  return (kNearPart * double{scale.near} - best) / (kNearnessUnit * double{scale.typical});
}

double ProfileLikelihood::Nearness(std::size_t journey, std::int64_t first,
                                   std::int64_t last) const {
  double sum = 0, count = 0;
  for (std::size_t side = 0; side < compared_.size(); ++side) {
    if (!compared_[side] || !routes_[journey].sides[side]) continue;
    sum += NearnessOfSide(side, journey, first, last);
    count += 1;
  }
  return count > 0 ? sum / count : 0;
}

void ProfileLikelihood::StartAtOffset(double offset) {
  OffsetValues start{};
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < kViews; ++i) {
    if (std::abs(kPathOffsets[i] - offset) < std::abs(kPathOffsets[nearest] - offset)) nearest = i;
  }
  start[nearest] = 1;
  anywhere_ = PathOffsets::Mix(start);
}

double ProfileLikelihood::MeanOffset() const {
  double mean = 0;
  for (std::size_t offset = 0; offset < kViews; ++offset) {
    mean += anywhere_[offset] * kPathOffsets[offset];
  }
  return mean;
}

}  // namespace homing
