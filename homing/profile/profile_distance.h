// The distance between two flow profiles.
#ifndef HOMING_PROFILE_PROFILE_DISTANCE_H_
#define HOMING_PROFILE_PROFILE_DISTANCE_H_

#include <array>
#include <cstdint>
#include <span>

#include "homing/landmark/flow_profile.h"

namespace homing {

// 255 for the cells that count, else 0.
using CellMask = std::array<std::uint8_t, FlowProfile::kCells>;

// The cells that an image fills after the changes of ProfileMaker::Make.
CellMask CoveredCells(double magnification, double shift = 0);

// One view of the seen profile, and its distance to each of the stored profiles: over the covered
// cells, the sum of 4 |gain of the count code| + 3 |loss of it| + where both have vectors,
// |difference of the parallax codes|, at most 6. 0 to 10560.
struct ProfileView {
  const FlowProfile& seen;
  const CellMask& covered;
  std::span<std::uint16_t> distances;
};

// Fills in the distances of all views to `stored`. REQUIRES: they are as long as stored.
void ProfileDistances(std::span<const ProfileView> views, std::span<const FlowProfile> stored);
void ProfileDistances(std::span<const ProfileView> views,
                      std::span<const FlowProfile* const> stored);

inline void ProfileDistances(const FlowProfile& seen, std::span<const FlowProfile> stored,
                             const CellMask& covered, std::span<std::uint16_t> distances) {
  const ProfileView view{seen, covered, distances};
  ProfileDistances({&view, 1}, stored);
}

// The plain reference: the same distances cell after cell, on any machine.
void PlainProfileDistances(const ProfileView& view, std::span<const FlowProfile> stored);

}  // namespace homing

#endif  // HOMING_PROFILE_PROFILE_DISTANCE_H_
