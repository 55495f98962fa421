// Distances of flow profiles, 32 stored ones at a time and cell by cell: the codes of a cell choose
// from a table of 16 costs, which the machine looks up 32 times in one instruction.
#ifndef HOMING_PROFILE_PROFILE_BLOCKS_H_
#define HOMING_PROFILE_PROFILE_BLOCKS_H_

#include <span>

#include "homing/profile/profile_distance.h"

namespace homing {

// True if this machine has AVX2.
bool ProfileBlocksFit();

// As ProfileDistances. REQUIRES: ProfileBlocksFit().
void ProfileDistancesByBlocks(std::span<const ProfileView> views,
                              std::span<const FlowProfile> stored);
void ProfileDistancesByBlocks(std::span<const ProfileView> views,
                              std::span<const FlowProfile* const> stored);

}  // namespace homing

#endif  // HOMING_PROFILE_PROFILE_BLOCKS_H_
