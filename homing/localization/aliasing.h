// How distinct the places of a map are: how many steps a robot must see to know its place, and
// which places look alike. See docs/algorithm.md.
#ifndef HOMING_LOCALIZATION_ALIASING_H_
#define HOMING_LOCALIZATION_ALIASING_H_

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "homing/base/cancellation.h"
#include "homing/landmark/flow_profile.h"

namespace homing {

// Profiles by side of the route, then by step; a side without profiles is empty, a step without one
// is all 0.
using RouteProfiles = std::array<std::vector<FlowProfile>, 2>;

struct AliasedPlaces {
  std::int64_t first_step = 0;
  std::int64_t second_step = 0;
  // Probability of the second place after a few steps, relative to 1 for the first. (0, 1].
  double confusion = 0;
};

struct Aliasing {
  // Steps that a robot must see until the place has a probability of 0.9: in half of the places,
  // and in 19 of 20. None: more than 100.
  std::optional<std::int64_t> median_steps;
  std::optional<std::int64_t> most_steps;
  // Fraction of the places that even then cannot be distinguished from others. 0..1.
  double indistinct_share = 0;
  // The most alike first; at most 20.
  std::vector<AliasedPlaces> aliased_places;
};

// Simulates a robot that drives the route again, either way, with the speed of the outbound trip;
// each view is as far from its step as the neighbouring step is. Steps nearer than
// `tolerance_steps` are one place. Long routes are sampled: the cost stays below that of comparing
// some 200 steps with all, at 10,000 steps about a second, or half a minute if the route repeats
// itself. If cancelled, returns the findings so far.
Aliasing AnalyzeAliasing(RouteProfiles profiles, std::int64_t tolerance_steps,
                         const Cancellation* cancellation = nullptr);

}  // namespace homing

#endif  // HOMING_LOCALIZATION_ALIASING_H_
