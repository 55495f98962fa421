// Bounds of 1 - F(delta) that cost a table look-up instead of a logarithm and an erfc.
// Source: after eqs 9, 14 (1 - F falls with delta).
#ifndef HOMING_MATCHING_SURVIVAL_BOUND_H_
#define HOMING_MATCHING_SURVIVAL_BOUND_H_

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "homing/similarity/deviation_model.h"

namespace homing {

// Steps are 1/16 of an octave of the squared distance wide: the bounds are at most 1 - F of a
// distance 3 % smaller, and at least that of one 3 % greater. 6.4 kB. Immutable.
class SurvivalBound {
 public:
  explicit SurvivalBound(const DeviationModel& model);

  // An upper bound of 1 - F for every distance whose square, computed in float, is `squared_px`.
  float At(float squared_px) const { return table_[static_cast<std::size_t>(IndexOf(squared_px))]; }
  // A lower bound of 1 - F for the same distances.
  float LeastAt(float squared_px) const {
    return least_[static_cast<std::size_t>(IndexOf(squared_px))];
  }
  // The squared distance, px^2, from which on At is less than `probability`.
  float ReachOf(double probability) const;
  // Index of At's table entry, for loops over many distances.
  static std::int32_t IndexOf(float squared_px) {
    // The bits of a float that is not negative grow with it.
    const std::int32_t place = (std::bit_cast<std::int32_t>(squared_px) >> kShift) - kFirst;
    return std::clamp(place, 0, kEntries - 1);
  }
  const float* table() const { return table_.data(); }

 private:
  // Bits of the 23-bit mantissa that the index keeps.
  static constexpr int kMantissaBits = 4;
  static constexpr int kShift = 23 - kMantissaBits;
  // The table covers squared distances from 2^-24 px^2, below which the bound is 1, to 2^26 px^2,
  // beyond which it is constant.
  static constexpr std::int32_t kFirst = (127 - 24) << kMantissaBits;
  static constexpr std::int32_t kEntries = 50 << kMantissaBits;

  std::array<float, kEntries> table_;
  std::array<float, kEntries> least_;
};

}  // namespace homing

#endif  // HOMING_MATCHING_SURVIVAL_BOUND_H_
