#include "homing/flow/median.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace homing {
namespace {

template <typename T>
T BySorting(std::vector<T> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

TEST(MedianTest, OfNoneIsZeroAndOfOneThatOne) {
  EXPECT_EQ(Median(std::vector<float>{}), 0);
  EXPECT_EQ(Median(std::vector<float>{-3}), -3);
  EXPECT_EQ(Median(std::vector<std::uint16_t>{}), 0);
  EXPECT_EQ(Median(std::vector<std::uint16_t>{65535}), 65535);
}

TEST(MedianTest, IsTheUpperOneOfTwoInTheMiddle) {
  EXPECT_EQ(Median(std::vector<float>{4, 1}), 4);
  EXPECT_EQ(Median(std::vector<float>{4, 1, 3, 2}), 3);
}

TEST(MedianTest, InfinitiesAndTheLeastNumbersHaveTheirPlace) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kLeast = std::numeric_limits<float>::denorm_min();
  EXPECT_EQ(Median(std::vector<float>{kInfinity, -kInfinity, kLeast}), kLeast);
  EXPECT_EQ(Median(std::vector<float>{kInfinity, kInfinity, 0}), kInfinity);
}

TEST(MedianTest, IsWhatSortingGives) {
  std::mt19937 random(5);
  std::normal_distribution<float> normal(0, 3);
  std::uniform_int_distribution<int> size(1, 300);
  std::uniform_int_distribution<int> few(-2, 2);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<float> values(static_cast<std::size_t>(size(random)));
    for (float& value : values) {
      value = trial % 2 == 0 ? normal(random) : static_cast<float>(few(random));
    }
    EXPECT_EQ(Median(values), BySorting(values));
  }
}

TEST(MedianTest, OfIntegersIsWhatSortingGives) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 2000; ++trial) {
    std::uniform_int_distribution<int> size(1, trial % 500 == 0 ? 100000 : 300);
    std::uniform_int_distribution<int> value(0, trial % 3 == 0 ? 65535 : 4);
    std::vector<std::uint16_t> values(static_cast<std::size_t>(size(random)));
    for (std::uint16_t& one : values) one = static_cast<std::uint16_t>(value(random));
    EXPECT_EQ(Median(values), BySorting(values));
  }
}

}  // namespace
}  // namespace homing
