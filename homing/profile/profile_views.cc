#include "homing/profile/profile_views.h"

namespace homing {
namespace {

using Masks = std::array<CellMask, kPathOffsets.size()>;

}  // namespace

FlowProfile MakeView(const ProfileMaker& seen, Seeing seeing, std::size_t view) {
  return seeing == Seeing::kBothSides ? seen.Make(MagnificationOf(view))
                                      : seen.Make(1, ShiftOf(view));
}

const CellMask& CoveredBy(Seeing seeing, std::size_t view) {
  static const auto masks = [] {
    std::array<Masks, 2> all;
    for (std::size_t i = 0; i < kPathOffsets.size(); ++i) {
      all[static_cast<std::size_t>(Seeing::kBothSides)][i] = CoveredCells(MagnificationOf(i));
      all[static_cast<std::size_t>(Seeing::kOneSide)][i] = CoveredCells(1, ShiftOf(i));
    }
    return all;
  }();
  return masks[static_cast<std::size_t>(seeing)][view];
}

}  // namespace homing
