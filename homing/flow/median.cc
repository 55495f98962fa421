#include "homing/flow/median.h"

#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "homing/vector_clones.h"

namespace homing {
namespace {

// Integers in the order of the numbers.
HOMING_VECTOR_CLONES
void RankKeys(const float* values, std::size_t size, std::int32_t* keys) {
  for (std::size_t i = 0; i < size; ++i) {
    const auto bits = std::bit_cast<std::int32_t>(values[i]);
    keys[i] = bits ^ ((bits >> 31) & std::numeric_limits<std::int32_t>::max());
  }
}

HOMING_VECTOR_CLONES
std::int32_t CountUpTo(const std::int32_t* keys, std::size_t size, std::int32_t most) {
  std::int32_t count = 0;
  for (std::size_t i = 0; i < size; ++i) {
    count += keys[i] <= most ? 1 : 0;
  }
  return count;
}

}  // namespace

float Median(std::span<const float> values) {
  if (values.empty()) {
    return 0;
  }
  std::vector<std::int32_t> keys(values.size());
  RankKeys(values.data(), values.size(), keys.data());
  // Of the keys the least that has more than half of them at or under it, by bisection.
  const auto half = static_cast<std::int32_t>(values.size() / 2);
  std::int64_t low = std::numeric_limits<std::int32_t>::min();
  std::int64_t high = std::numeric_limits<std::int32_t>::max();
  while (low < high) {
    const auto middle = static_cast<std::int32_t>((low + high) >> 1);
    if (CountUpTo(keys.data(), keys.size(), middle) > half) {
      high = middle;
    } else {
      low = std::int64_t{middle} + 1;
    }
  }
  const auto key = static_cast<std::int32_t>(low);
  return std::bit_cast<float>(key ^ ((key >> 31) & std::numeric_limits<std::int32_t>::max()));
}

}  // namespace homing
