#include "client/bench/latency_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace homing::client {
namespace {

TEST(LatencyHistogramTest, OfNoneThePercentileIsZero) {
  EXPECT_EQ(LatencyHistogram().PercentileMs(0.5), 0);
}

TEST(LatencyHistogramTest, PercentilesAreThoseOfTheSortedListToOneInSixtyFour) {
  std::mt19937 random(1);
  std::lognormal_distribution<double> draw(8, 3);
  LatencyHistogram histogram;
  std::vector<double> sorted;
  for (int i = 0; i < 20'000; ++i) {
    const double us = std::floor(std::min(draw(random), 3e9));
    histogram.Add(std::chrono::nanoseconds(static_cast<std::int64_t>(us * 1000)));
    sorted.push_back(us * 1e-3);
  }
  std::sort(sorted.begin(), sorted.end());
  for (const double share : {0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const double exact = sorted[static_cast<std::size_t>(std::ceil(share * 20'000)) - 1];
    EXPECT_GE(histogram.PercentileMs(share), exact) << share;
    EXPECT_LE(histogram.PercentileMs(share), exact * (1 + 1.0 / 64) + 1e-9) << share;
  }
  EXPECT_DOUBLE_EQ(histogram.max_ms(), sorted.back());
}

TEST(LatencyHistogramTest, TwoTogetherAreAsOneOfBoth) {
  LatencyHistogram one;
  LatencyHistogram other;
  one.Add(std::chrono::milliseconds(1));
  other.Add(std::chrono::milliseconds(100));
  one.Add(other);
  EXPECT_EQ(one.count(), 2U);
  EXPECT_DOUBLE_EQ(one.max_ms(), 100);
  EXPECT_NEAR(one.PercentileMs(0.5), 1, 1.0 / 64);
}

TEST(LatencyHistogramTest, AClockThatGoesBackCountsAsNoTime) {
  LatencyHistogram histogram;
  histogram.Add(std::chrono::nanoseconds(-5));
  EXPECT_EQ(histogram.count(), 1U);
  EXPECT_EQ(histogram.max_ms(), 0);
}

}  // namespace
}  // namespace homing::client
