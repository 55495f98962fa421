#include "server/clock_watch.h"

#include <gtest/gtest.h>

namespace homing::server {
namespace {

using std::chrono::minutes;

constexpr std::int64_t kMinute = 60'000'000'000;
constexpr std::int64_t kNow = ClockWatch::kEarliestNs + 1000 * kMinute;

class ClockWatchTest : public ::testing::Test {
 protected:
  std::int64_t Since(std::int64_t wall_ns, int minutes_passed) {
    return watch_.TrustedSince(
        wall_ns, std::chrono::steady_clock::time_point(minutes(100 + minutes_passed)));
  }
  ClockWatch watch_;
};

TEST_F(ClockWatchTest, NoAgeIsTrustedInTheFirstTenMinutes) {
  constexpr std::int64_t kFiftyYears = 50 * 365 * 24 * 60 * kMinute;
  EXPECT_GT(Since(kNow + kFiftyYears, 0), kNow + kFiftyYears);
  EXPECT_GT(Since(kNow + kFiftyYears + 9 * kMinute, 9), kNow + kFiftyYears);
  EXPECT_EQ(Since(kNow + 10 * kMinute, 10), ClockWatch::kEarliestNs);
}

TEST_F(ClockWatchTest, ASteadyClockIsTrusted) {
  Since(kNow, 0);
  EXPECT_EQ(Since(kNow + 60 * kMinute, 60), ClockWatch::kEarliestNs);
  EXPECT_EQ(Since(kNow + 63 * kMinute, 61), ClockWatch::kEarliestNs);
}

TEST_F(ClockWatchTest, WhatWasMadeIn1970IsNotTrusted) {
  EXPECT_GT(Since(60'000'000'000, 0), 60'000'000'000);
}

TEST_F(ClockWatchTest, AfterAJumpOnlyWhatIsNewIsTrusted) {
  Since(kNow, 0);
  const std::int64_t learnt = kNow + 50'000 * kMinute;
  EXPECT_EQ(Since(learnt, 11), learnt);
  EXPECT_EQ(Since(learnt + kMinute, 12), learnt);
}

TEST_F(ClockWatchTest, AClockThatIsSetBackIsNoReason) {
  Since(kNow, 0);
  EXPECT_EQ(Since(kNow - 500 * kMinute, 11), ClockWatch::kEarliestNs);
}

TEST_F(ClockWatchTest, TenMinutesAfterAJumpWasTakenBackAgesAreTrustedAgain) {
  constexpr std::int64_t kYear = 365 * 24 * 60 * kMinute;
  Since(kNow, 0);
  EXPECT_EQ(Since(kNow + 20 * kMinute + kYear, 20), kNow + 20 * kMinute + kYear);
  EXPECT_GT(Since(kNow + 30 * kMinute, 30), kNow + kYear);
  EXPECT_GT(Since(kNow + 39 * kMinute, 39), kNow + kYear);
  EXPECT_EQ(Since(kNow + 40 * kMinute, 40), ClockWatch::kEarliestNs);
}

TEST_F(ClockWatchTest, AJumpThatIsTakenBackInPartIsStillAJump) {
  constexpr std::int64_t kYear = 365 * 24 * 60 * kMinute;
  Since(kNow, 0);
  const std::int64_t jumped = kNow + 20 * kMinute + kYear;
  EXPECT_EQ(Since(jumped, 20), jumped);
  EXPECT_EQ(Since(jumped - kYear / 2, 30), jumped);
  EXPECT_EQ(Since(jumped - kYear / 2 + 30 * kMinute, 60), jumped);
}

TEST_F(ClockWatchTest, AfterAJumpWasTakenBackTheJumpBeforeItCounts) {
  Since(60'000'000'000, 0);
  EXPECT_EQ(Since(kNow, 20), kNow);
  Since(kNow + 500 * kMinute, 30);
  Since(kNow + 20 * kMinute, 40);
  EXPECT_EQ(Since(kNow + 30 * kMinute, 50), kNow);
}

}  // namespace
}  // namespace homing::server
