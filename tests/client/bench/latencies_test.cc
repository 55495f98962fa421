#include "client/bench/latencies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace homing::client {
namespace {

TEST(LatenciesTest, OfNoneThePercentileIsZero) { EXPECT_EQ(Latencies().PercentileMs(0.5), 0); }

TEST(LatenciesTest, PercentilesAreThoseOfTheSortedList) {
  std::mt19937 random(1);
  std::lognormal_distribution<double> draw(8, 3);
  Latencies latencies;
  std::vector<double> sorted;
  for (int i = 0; i < 20'000; ++i) {
    const double us = std::floor(std::min(draw(random), 3e9));
    latencies.Add(std::chrono::nanoseconds(static_cast<std::int64_t>(us * 1000)));
    sorted.push_back(us * 1e-3);
  }
  std::sort(sorted.begin(), sorted.end());
  for (const double share : {0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const double exact = sorted[static_cast<std::size_t>(std::ceil(share * 20'000)) - 1];
    EXPECT_DOUBLE_EQ(latencies.PercentileMs(share), exact) << share;
  }
  EXPECT_DOUBLE_EQ(latencies.max_ms(), sorted.back());
}

TEST(LatenciesTest, TwoTogetherAreAsOneOfBoth) {
  Latencies one;
  Latencies other;
  one.Add(std::chrono::milliseconds(1));
  other.Add(std::chrono::milliseconds(100));
  one.Add(other);
  EXPECT_EQ(one.count(), 2U);
  EXPECT_DOUBLE_EQ(one.max_ms(), 100);
  EXPECT_DOUBLE_EQ(one.PercentileMs(0.5), 1);
}

TEST(LatenciesTest, AClockThatGoesBackCountsAsNoTime) {
  Latencies latencies;
  latencies.Add(std::chrono::nanoseconds(-5));
  EXPECT_EQ(latencies.count(), 1U);
  EXPECT_EQ(latencies.max_ms(), 0);
}

}  // namespace
}  // namespace homing::client
