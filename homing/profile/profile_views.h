// The present views as the outbound robot would have seen them. A robot that drives further left or
// right sees one side of the route larger and the other smaller: two cameras show its offset. One
// camera cannot tell an offset from other changes; it shows the heading, which moves the image
// sideways. Offsets have the unit "scene distance", the mean distance of the objects that the
// camera sees.
#ifndef HOMING_PROFILE_PROFILE_VIEWS_H_
#define HOMING_PROFILE_PROFILE_VIEWS_H_

#include <array>
#include <cstddef>
#include <optional>

#include "homing/landmark/flow_profile.h"
#include "homing/profile/profile_distance.h"

namespace homing {

// Offsets to the left of the outbound path, in scene distances.
inline constexpr std::array<double, 7> kPathOffsets = {-0.35, -0.23, -0.11, 0, 0.11, 0.23, 0.35};
inline constexpr std::size_t kNoOffset = kPathOffsets.size() / 2;
static_assert(kPathOffsets[kNoOffset] == 0);

// Magnification of each view relative to the camera's image.
constexpr double MagnificationOf(std::size_t view) { return 1 + kPathOffsets[view]; }

// The view of `side` of the route for the path offset of index `offset`: nearer on one side is
// further away on the other.
constexpr std::size_t ViewOf(std::size_t side, std::size_t offset) {
  return side == 0 ? kPathOffsets.size() - 1 - offset : offset;
}

// Headings that one camera tries instead, by the same indices: shift of the image to the right,
// image widths.
constexpr double ShiftOf(std::size_t view) { return 0.1 * kPathOffsets[view]; }

// How many cameras are compared.
enum class Seeing { kBothSides, kOneSide };

FlowProfile MakeView(const ProfileMaker& seen, Seeing seeing, std::size_t view);
// The cells of a view that the camera's image covers.
const CellMask& CoveredBy(Seeing seeing, std::size_t view);

// Indexed by side of the ROUTE; none where no camera looks.
using SeenProfiles = std::array<std::optional<ProfileMaker>, 2>;

}  // namespace homing

#endif  // HOMING_PROFILE_PROFILE_VIEWS_H_
