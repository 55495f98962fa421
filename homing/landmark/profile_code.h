// Flow profiles as bytes, for disk and wire.
#ifndef HOMING_LANDMARK_PROFILE_CODE_H_
#define HOMING_LANDMARK_PROFILE_CODE_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "homing/landmark/flow_profile.h"

namespace homing {

// Bytes of a profile that is not all 0.
inline constexpr std::size_t kProfileBytes = 128;

// The odometer reading (median_x and expansion, low byte first, length code, spread code, turn),
// then a nibble of count code a cell, then a nibble of parallax code for two cells; the first of
// two in the low nibble. No bytes for a profile that is all 0.
std::string EncodeProfile(const FlowProfile& profile);

// Also reads the format of 126 bytes, without the turn, and that of the first releases, 12 x 8
// cells without odometer: resampled by area. INVALID_ARGUMENT: anything else.
absl::StatusOr<FlowProfile> DecodeProfile(std::string_view bytes);

}  // namespace homing

#endif  // HOMING_LANDMARK_PROFILE_CODE_H_
