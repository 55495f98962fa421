// How well a map tells its own places apart: how many steps a robot must see, and which places look
// alike.
#ifndef HOMING_LOCALIZATION_ALIASING_H_
#define HOMING_LOCALIZATION_ALIASING_H_

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "homing/base/cancellation.h"
#include "homing/landmark/flow_profile.h"

namespace homing {

// By side of the route, then by step; a side without profiles is empty, a step without is all 0.
using RouteProfiles = std::array<std::vector<FlowProfile>, 2>;

struct Twins {
  std::int64_t first_step = 0;
  std::int64_t second_step = 0;
  // How probable the second is after a few steps, beside 1 for the first. (0, 1].
  double confusion = 0;
};

struct Aliasing {
  // Steps to be seen until the place is 0.9 probable: in half of the places, in 19 of 20. None:
  // more than are tried (100).
  std::optional<std::int64_t> median_steps;
  std::optional<std::int64_t> most_steps;
  // Places that even then are not told from others. 0..1.
  double indistinct_share = 0;
  // The most alike first; at most 20.
  std::vector<Twins> twins;
};

// A robot drives the route again, either way, with the speed of the outbound trip, and sees each
// step as unlike as its neighbour is. Steps nearer than `tolerance_steps` are one place. Long
// routes are sampled: the cost stays below that of some 200 steps against all, at 10,000 steps
// about a second, or half a minute if the route repeats itself. Nobody waits any more: what was
// found so far.
Aliasing AnalyzeAliasing(RouteProfiles profiles, std::int64_t tolerance_steps,
                         const Cancellation* cancellation = nullptr);

}  // namespace homing

#endif  // HOMING_LOCALIZATION_ALIASING_H_
