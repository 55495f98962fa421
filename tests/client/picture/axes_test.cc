#include "client/picture/axes.h"

#include <gtest/gtest.h>

namespace homing::client {
namespace {

TEST(AxesTest, TicksAreRoundAndInside) {
  EXPECT_EQ(RoundTicks({0, 320}, 6), (std::vector<double>{0, 50, 100, 150, 200, 250, 300}));
  EXPECT_EQ(RoundTicks({0, 1}, 5), (std::vector<double>{0, 0.2, 0.4, 0.6000000000000001, 0.8, 1}));
  EXPECT_EQ(RoundTicks({7, 13}, 3), (std::vector<double>{8, 10, 12}));
}

TEST(AxesTest, TicksOfARangeThatRunsDownwardsAreTheSame) {
  EXPECT_EQ(RoundTicks({240, 0}, 5), RoundTicks({0, 240}, 5));
}

TEST(AxesTest, AnEmptyRangeHasOneTick) { EXPECT_EQ(RoundTicks({3, 3}, 5), std::vector<double>{3}); }

TEST(AxesTest, MapsValuesToTheBox) {
  Axes axes(nullptr, {10, 20, 100, 50}, {0, 10}, {0, 1});
  EXPECT_DOUBLE_EQ(axes.X(0), 10);
  EXPECT_DOUBLE_EQ(axes.X(10), 110);
  EXPECT_DOUBLE_EQ(axes.Y(0), 70);
  EXPECT_DOUBLE_EQ(axes.Y(1), 20);
}

}  // namespace
}  // namespace homing::client
