#include "homing/localization/profile_distance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "homing/vector_clones.h"

namespace homing {
namespace {

constexpr std::uint8_t kMostParallax = 6;

// Of the middle of the cell from the middle of the image, in halves of the image.
double FromMiddle(int cell, int cells) { return std::abs((cell + 0.5) / cells - 0.5) * 2; }

}  // namespace

CellMask CoveredCells(double magnification) {
  CellMask covered{};
  for (int row = 0; row < FlowProfile::kRows; ++row) {
    for (int column = 0; column < FlowProfile::kColumns; ++column) {
      const double outmost =
          std::max(FromMiddle(row, FlowProfile::kRows), FromMiddle(column, FlowProfile::kColumns));
      const int cell = row * FlowProfile::kColumns + column;
      covered[static_cast<std::size_t>(cell)] = outmost <= magnification ? 255 : 0;
    }
  }
  return covered;
}

HOMING_VECTOR_CLONES
void ProfileDistances(const FlowProfile& seen, std::span<const FlowProfile> stored,
                      const CellMask& covered, std::span<std::uint16_t> distances) {
  const std::uint8_t* const a = seen.cells.data();
  const std::uint8_t* const mask = covered.data();
  for (std::size_t i = 0; i < stored.size(); ++i) {
    const std::uint8_t* const b = stored[i].cells.data();
    std::uint16_t sum = 0;
    for (std::size_t cell = 0; cell < FlowProfile::kCells; ++cell) {
      const std::uint8_t share_a = a[cell] & 15;
      const std::uint8_t share_b = b[cell] & 15;
      const std::uint8_t parallax_a = a[cell] >> 4;
      const std::uint8_t parallax_b = b[cell] >> 4;
      // What is gone says less than what has come: landmarks vanish, and poor light hides.
      const auto gone = static_cast<std::uint8_t>(share_b - std::min(share_a, share_b));
      const auto come = static_cast<std::uint8_t>(share_a - std::min(share_a, share_b));
      const std::uint8_t parallax = std::min<std::uint8_t>(
          kMostParallax, static_cast<std::uint8_t>(std::max(parallax_a, parallax_b) -
                                                   std::min(parallax_a, parallax_b)));
      const std::uint8_t both = parallax_a != 0 && parallax_b != 0 ? 255 : 0;
      const auto cost = static_cast<std::uint8_t>(gone * 3 + come * 4 + (parallax & both));
      sum = static_cast<std::uint16_t>(sum + (cost & mask[cell]));
    }
    distances[i] = sum;
  }
}

}  // namespace homing
