// The cost of one cell in the distance of two flow profiles. The values were fitted to matched and
// unmatched pairs (docs/algorithm.md).
#ifndef HOMING_PROFILE_CELL_COSTS_H_
#define HOMING_PROFILE_CELL_COSTS_H_

#include <algorithm>
#include <cstdint>

namespace homing {

// Cost of the count codes seen and stored, 0 to 60. A loss of vectors costs less than a gain:
// landmarks vanish, and poor light hides them.
constexpr std::uint8_t CountCost(std::uint8_t seen, std::uint8_t stored) {
  const std::uint8_t common = std::min(seen, stored);
  return static_cast<std::uint8_t>((stored - common) * 3 + (seen - common) * 4);
}

// Cost of the parallax codes where both profiles have vectors, 0 to 6.
constexpr std::uint8_t ParallaxCost(std::uint8_t seen, std::uint8_t stored) {
  constexpr std::uint8_t kMost = 6;
  const std::uint8_t both = seen != 0 && stored != 0 ? 255 : 0;
  const auto apart = static_cast<std::uint8_t>(std::max(seen, stored) - std::min(seen, stored));
  return std::min(kMost, apart) & both;
}

}  // namespace homing

#endif  // HOMING_PROFILE_CELL_COSTS_H_
