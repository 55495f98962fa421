#include "client/backoff.h"

#include <gtest/gtest.h>

namespace homing::client {
namespace {

using std::chrono::milliseconds;

TEST(BackoffTest, GrowsFromTheFirstWaitToTheLongest) {
  BackoffOptions options{milliseconds(100), milliseconds(350), 2.0, 0.0};
  Backoff backoff(options);
  EXPECT_EQ(backoff.Next(), milliseconds(100));
  EXPECT_EQ(backoff.Next(), milliseconds(200));
  EXPECT_EQ(backoff.Next(), milliseconds(350));
  EXPECT_EQ(backoff.Next(), milliseconds(350));
}

TEST(BackoffTest, BeginsAgainAfterReset) {
  BackoffOptions options{milliseconds(100), milliseconds(350), 2.0, 0.0};
  Backoff backoff(options);
  backoff.Next();
  backoff.Next();
  backoff.Reset();
  EXPECT_EQ(backoff.Next(), milliseconds(100));
}

TEST(BackoffTest, JitterOnlyShortens) {
  BackoffOptions options{milliseconds(1000), milliseconds(1000), 1.0, 0.3};
  Backoff backoff(options);
  for (int i = 0; i < 100; ++i) {
    const milliseconds wait = backoff.Next();
    EXPECT_GE(wait, milliseconds(699));
    EXPECT_LE(wait, milliseconds(1000));
  }
}

TEST(BackoffTest, SleepEndsAtOnceWhenStopped) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(SleepFor(std::chrono::hours(1), stop.get_token()));
  EXPECT_TRUE(SleepFor(milliseconds(1), {}));
}

}  // namespace
}  // namespace homing::client
