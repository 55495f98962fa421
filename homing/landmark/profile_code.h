// Flow profiles as bytes, for disk and wire. Source: own design.
#ifndef HOMING_LANDMARK_PROFILE_CODE_H_
#define HOMING_LANDMARK_PROFILE_CODE_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "homing/landmark/flow_profile.h"

namespace homing {

// Twelve bytes with a bit a cell (cell 0 lowest in the first), set where the cell is not 0; then
// those cells in order. At most 108 bytes; none for a profile that is all 0.
std::string EncodeProfile(const FlowProfile& profile);

// INVALID_ARGUMENT: what EncodeProfile does not write.
absl::StatusOr<FlowProfile> DecodeProfile(std::string_view bytes);

}  // namespace homing

#endif  // HOMING_LANDMARK_PROFILE_CODE_H_
