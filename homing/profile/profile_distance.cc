#include "homing/profile/profile_distance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "homing/profile/cell_costs.h"
#include "homing/profile/profile_blocks.h"

namespace homing {
namespace {

// Distance of the cell's middle from the middle of the image, in halves of the image.
double FromMiddle(int cell, int cells) { return std::abs((cell + 0.5) / cells - 0.5) * 2; }

}  // namespace

CellMask CoveredCells(double magnification, double shift) {
  CellMask covered{};
  for (int row = 0; row < FlowProfile::kRows; ++row) {
    for (int column = 0; column < FlowProfile::kColumns; ++column) {
      const double outmost =
          std::max(FromMiddle(row, FlowProfile::kRows), FromMiddle(column, FlowProfile::kColumns));
      const int cell = row * FlowProfile::kColumns + column;
      const double before = (column + 0.5) / FlowProfile::kColumns - shift;
      const bool is_covered = outmost <= magnification && before >= 0 && before <= 1;
      covered[static_cast<std::size_t>(cell)] = is_covered ? 255 : 0;
    }
  }
  return covered;
}

void PlainProfileDistances(const ProfileView& view, std::span<const FlowProfile> stored) {
  const std::uint8_t* const a = view.seen.cells.data();
  const std::uint8_t* const mask = view.covered.data();
  for (std::size_t i = 0; i < stored.size(); ++i) {
    const std::uint8_t* const b = stored[i].cells.data();
    std::uint16_t sum = 0;
    for (std::size_t cell = 0; cell < FlowProfile::kCells; ++cell) {
      const auto cost = static_cast<std::uint8_t>(CountCost(a[cell] & 15, b[cell] & 15) +
                                                  ParallaxCost(a[cell] >> 4, b[cell] >> 4));
      sum = static_cast<std::uint16_t>(sum + (cost & mask[cell]));
    }
    view.distances[i] = sum;
  }
}

void ProfileDistances(std::span<const ProfileView> views, std::span<const FlowProfile> stored) {
  if (ProfileBlocksFit()) {
    ProfileDistancesByBlocks(views, stored);
    return;
  }
  for (const ProfileView& view : views) PlainProfileDistances(view, stored);
}

void ProfileDistances(std::span<const ProfileView> views,
                      std::span<const FlowProfile* const> stored) {
  if (ProfileBlocksFit()) {
    ProfileDistancesByBlocks(views, stored);
    return;
  }
  for (const auto& [seen, covered, distances] : views) {
    for (std::size_t i = 0; i < stored.size(); ++i) {
      PlainProfileDistances({seen, covered, distances.subspan(i, 1)}, {stored[i], 1});
    }
  }
}

}  // namespace homing
