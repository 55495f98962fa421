// The believed place of the robot at the instant whose profiles a ProfileLikelihood compared.
#include <algorithm>

#include "homing/profile/profile_likelihood.h"
#include "homing/profile/profile_views.h"

namespace homing {

std::size_t ProfileLikelihood::LikeliestOffset() const {
  // With one camera the seven views are headings, which do not change the scene: the view without a
  // shift is compared.
  if (seeing_ == Seeing::kOneSide) return kNoOffset;
  // The belief may have moved to an offset that was not tried at this instant.
  std::size_t likeliest = kNoOffset;
  double most = -1;
  for (std::size_t offset = 0; offset < kViews; ++offset) {
    if (!chosen_[offset] || anywhere()[offset] <= most) continue;
    likeliest = offset;
    most = anywhere()[offset];
  }
  return likeliest;
}

BelievedInstant ProfileLikelihood::Believed(std::size_t journey, std::int64_t first,
                                            std::int64_t last) const {
  const std::size_t offset = LikeliestOffset();
  const std::int64_t held = first_steps_[journey];
  std::vector<std::int32_t> sums;
  BelievedInstant instant{.journey = journey, .step = std::max(first, held)};
  for (std::size_t side = 0; side < compared_.size(); ++side) {
    if (!compared_[side]) continue;
    const std::size_t view = ViewOf(side, offset);
    const auto seen = std::ranges::find(views_[side], view, &SeenView::view);
    instant.seen[side] = {.profile = seen->profile, .covered = &CoveredBy(seeing_, view)};
    const std::vector<std::uint16_t>& distances = distances_[side][view][journey];
    if (distances.empty()) continue;
    const std::int64_t end = std::min(last + 1, held + std::ssize(distances));
    sums.resize(static_cast<std::size_t>(std::max<std::int64_t>(0, end - instant.step)));
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const auto step = static_cast<std::size_t>(instant.step) + i;
      sums[i] += int{distances[step - static_cast<std::size_t>(held)]} -
                 int{routes_[journey]->sides[side]->bias[step]};
    }
  }
  instant.step += std::ranges::min_element(sums) - sums.begin();
  return instant;
}

}  // namespace homing
