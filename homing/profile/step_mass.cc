#include "homing/profile/step_mass.h"

#include <array>
#include <cstddef>

#include "homing/base/vector_clones.h"

namespace homing {

HOMING_VECTOR_CLONES
double SumOf(std::span<const float> values) {
  constexpr std::size_t kParts = 16;
  std::array<double, kParts> parts{};
  const float* const from = values.data();
  const std::size_t whole = values.size() / kParts * kParts;
  for (std::size_t i = 0; i < whole; i += kParts) {
    for (std::size_t part = 0; part < kParts; ++part) parts[part] += double{from[i + part]};
  }
  double sum = 0;
  for (std::size_t i = whole; i < values.size(); ++i) sum += double{from[i]};
  for (const double part : parts) sum += part;
  return sum;
}

}  // namespace homing
