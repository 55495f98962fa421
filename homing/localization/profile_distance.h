// How unlike two flow profiles are. Source: own design.
#ifndef HOMING_LOCALIZATION_PROFILE_DISTANCE_H_
#define HOMING_LOCALIZATION_PROFILE_DISTANCE_H_

#include <array>
#include <cstdint>
#include <span>

#include "homing/landmark/flow_profile.h"

namespace homing {

// 255 for the cells that count, else 0.
using CellMask = std::array<std::uint8_t, FlowProfile::kCells>;

// The cells that an image magnified by `magnification` fills.
CellMask CoveredCells(double magnification);

// To each of `stored`: over the covered cells, the sum of 4 |difference of the share codes| + where
// both have vectors, |difference of the parallax codes|, at most 6. 0 to 6336. REQUIRES: distances
// is as long as stored.
void ProfileDistances(const FlowProfile& seen, std::span<const FlowProfile> stored,
                      const CellMask& covered, std::span<std::uint16_t> distances);

}  // namespace homing

#endif  // HOMING_LOCALIZATION_PROFILE_DISTANCE_H_
