#include "client/command/progress.h"

#include <gtest/gtest.h>

namespace homing::client {
namespace {

TEST(ProgressTest, RateAndTimeLeft) {
  EXPECT_EQ(ProgressText("recording", 100, 150, 1200, 10),
            "recording [###...........................] 150/1200  10.0/s  1:45 left");
  EXPECT_EQ(ProgressText("recording", 100, 100, 100, 10),
            "recording [##############################] 100/100  10.0/s");
}

TEST(ProgressTest, ASourceWithoutEndHasNoTimeLeft) {
  EXPECT_EQ(ProgressText("recording", 30, 30, -1, 2), "recording 30  15.0/s");
}

TEST(ProgressTest, NoRateInTheFirstSecond) {
  EXPECT_EQ(ProgressText("recording", 30, 30, -1, 0.5), "recording 30");
  EXPECT_EQ(ProgressText("recording", 0, 40, -1, 5), "recording 40");
}

}  // namespace
}  // namespace homing::client
