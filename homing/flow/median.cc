#include "homing/flow/median.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <numeric>

#include "absl/container/fixed_array.h"
#include "homing/base/vector_clones.h"

namespace homing {
namespace {

// Maps floats to integers of the same order.
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

HOMING_VECTOR_CLONES
void FindBounds(const std::int32_t* keys, std::size_t size, std::int32_t* least,
                std::int32_t* most) {
  std::int32_t low = std::numeric_limits<std::int32_t>::max();
  std::int32_t high = std::numeric_limits<std::int32_t>::min();
  for (std::size_t i = 0; i < size; ++i) {
    low = std::min(low, keys[i]);
    high = std::max(high, keys[i]);
  }
  *least = low;
  *most = high;
}

// The greatest key up to `most`. REQUIRES: there is one.
HOMING_VECTOR_CLONES
std::int32_t GreatestUpTo(const std::int32_t* keys, std::size_t size, std::int32_t most) {
  constexpr std::int32_t kLeast = std::numeric_limits<std::int32_t>::min();
  std::int32_t greatest = kLeast;
  for (std::size_t i = 0; i < size; ++i) {
    greatest = std::max(greatest, keys[i] <= most ? keys[i] : kLeast);
  }
  return greatest;
}

// The least key with more than half of all keys at or below it, by bisection. Stops early when
// exactly one more than half of the keys are at or below the middle.
std::int32_t MedianOf(std::span<const std::int32_t> keys) {
  const auto half = static_cast<std::int32_t>(keys.size() / 2);
  std::int32_t low = 0;
  std::int32_t high = 0;
  FindBounds(keys.data(), keys.size(), &low, &high);
  while (low < high) {
    const std::int32_t middle = std::midpoint(low, high);
    const std::int32_t count = CountUpTo(keys.data(), keys.size(), middle);
    if (count == half + 1) {
      return GreatestUpTo(keys.data(), keys.size(), middle);
    }
    if (count > half) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

// Up to this many keys need no memory from the heap.
constexpr std::size_t kUsual = 1024;

// So few values that a 16-bit counter cannot overflow.
constexpr std::size_t kCounted = 32768;

HOMING_VECTOR_CLONES
std::uint16_t CountBelow(const std::uint16_t* values, std::size_t size, std::uint16_t bound) {
  std::uint16_t count = 0;
  for (std::size_t i = 0; i < size; ++i) {
    count = static_cast<std::uint16_t>(count + (values[i] < bound ? 1 : 0));
  }
  return count;
}

std::size_t CountAllBelow(std::span<const std::uint16_t> values, std::uint16_t bound) {
  std::size_t count = 0;
  for (; values.size() > kCounted; values = values.subspan(kCounted)) {
    count += CountBelow(values.data(), kCounted, bound);
  }
  return count + CountBelow(values.data(), values.size(), bound);
}

}  // namespace

float Median(std::span<const float> values) {
  if (values.empty()) {
    return 0;
  }
  absl::FixedArray<std::int32_t, kUsual> keys(values.size());
  RankKeys(values.data(), values.size(), keys.data());
  const std::int32_t key = MedianOf({keys.data(), keys.size()});
  return std::bit_cast<float>(key ^ ((key >> 31) & std::numeric_limits<std::int32_t>::max()));
}

// Builds, from the highest bit down, the greatest value with at most half of the values below it.
std::uint16_t Median(std::span<const std::uint16_t> values) {
  unsigned median = 0;
  for (unsigned bit = 1U << 15U; bit > 0 && !values.empty(); bit >>= 1U) {
    const auto bound = static_cast<std::uint16_t>(median | bit);
    if (CountAllBelow(values, bound) <= values.size() / 2) median = bound;
  }
  return static_cast<std::uint16_t>(median);
}

}  // namespace homing
