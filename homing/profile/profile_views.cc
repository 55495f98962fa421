#include "homing/profile/profile_views.h"

namespace homing {

const CellMask& CoveredBy(std::size_t view) {
  static const auto masks = [] {
    std::array<CellMask, kPathOffsets.size()> all;
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = CoveredCells(MagnificationOf(i));
    return all;
  }();
  return masks[view];
}

}  // namespace homing
