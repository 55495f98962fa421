// Rates and open streams.
#include <string>
#include <vector>

#include "server/admission/rate_limiter.h"
#include "server/admission/stream_limiter.h"
#include "server/base/error_reason.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

TEST(RateLimiterTest, TwiceTheRateAtOnceAndThenTheRate) {
  RateLimiter limiter(10);
  TimePoint now{};
  for (int i = 0; i < 20; ++i) {
    EXPECT_THAT(limiter.Take("robots/r", now), IsOk()) << i;
  }
  const absl::Status refused = limiter.Take("robots/r", now);
  EXPECT_THAT(refused, StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("max-robot-rate")));
  EXPECT_EQ(ReasonOf(refused).reason, "RATE");
  EXPECT_EQ(ReasonOf(refused).metadata.at(kRetryAfterMs), "100");
  now += milliseconds(100);
  EXPECT_THAT(limiter.Take("robots/r", now), IsOk());
  EXPECT_FALSE(limiter.Take("robots/r", now).ok());
  // A clock that stands still, or an hour's pause, gives no more than the burst.
  now += std::chrono::hours(1);
  int taken = 0;
  while (limiter.Take("robots/r", now).ok()) {
    ++taken;
  }
  EXPECT_EQ(taken, 20);
}

TEST(RateLimiterTest, RobotsDoNotTakeEachOthersTokens) {
  RateLimiter limiter(1);
  EXPECT_THAT(limiter.Take("robots/a", {}), IsOk());
  EXPECT_THAT(limiter.Take("robots/a", {}), IsOk());
  EXPECT_FALSE(limiter.Take("robots/a", {}).ok());
  EXPECT_THAT(limiter.Take("robots/b", {}), IsOk());
}

TEST(RateLimiterTest, NamesThatComeOnceAreForgotten) {
  RateLimiter limiter(1);
  TimePoint now{};
  ASSERT_THAT(limiter.Take("robots/a", now), IsOk());
  ASSERT_THAT(limiter.Take("robots/a", now), IsOk());
  for (int i = 0; i < 5000; ++i) {
    EXPECT_THAT(limiter.Take("robots/" + std::to_string(i), now), IsOk());
  }
  // One that is not full again is not forgotten.
  EXPECT_FALSE(limiter.Take("robots/a", now).ok());
}

TEST(RateLimiterTest, ZeroIsNoLimit) {
  RateLimiter limiter(0);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_THAT(limiter.Take("robots/r", {}), IsOk());
  }
}

TEST(StreamLimiterTest, APlaceIsGivenBackOnce) {
  StreamLimiter limiter(2, 1);
  auto first = limiter.Enter("robots/a");
  ASSERT_THAT(first, IsOk());
  const auto second = limiter.Enter("robots/a");
  EXPECT_EQ(ReasonOf(second.status()).reason, "ROBOT_STREAMS");
  ASSERT_THAT(limiter.Enter("robots/b"), IsOk());
  EXPECT_EQ(limiter.open(), 1);
  StreamLimiter::Slot moved = *std::move(first);
  first->Leave();
  EXPECT_EQ(limiter.open(), 1);
  moved.Leave();
  moved.Leave();
  EXPECT_EQ(limiter.open(), 0);
  EXPECT_THAT(limiter.Enter("robots/a"), IsOk());
}

TEST(StreamLimiterTest, TheLimitOfAllHoldsWhoeverCalls) {
  StreamLimiter limiter(2, 0);
  const auto a = limiter.Enter("");
  const auto b = limiter.Enter("robots/a");
  ASSERT_THAT(a, IsOk());
  ASSERT_THAT(b, IsOk());
  const auto c = limiter.Enter("robots/c");
  EXPECT_THAT(c, StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("max-streams is 2")));
  EXPECT_EQ(ReasonOf(c.status()).reason, "STREAMS");
}

TEST(StreamLimiterTest, OneRobotCannotKeepOutTheOthers) {
  StreamLimiter limiter(100, 0);
  std::vector<StreamLimiter::Slot> of_one;
  absl::Status refused;
  while (refused.ok()) {
    auto slot = limiter.Enter("robots/a");
    refused = slot.status();
    if (slot.ok()) of_one.push_back(*std::move(slot));
  }
  EXPECT_EQ(of_one.size(), 75);
  EXPECT_EQ(ReasonOf(refused).reason, "STREAMS");
  std::vector<StreamLimiter::Slot> of_others;
  for (int i = 0; i < 25; ++i) {
    auto slot = limiter.Enter("robots/" + std::to_string(i));
    ASSERT_THAT(slot, IsOk()) << i;
    of_others.push_back(*std::move(slot));
  }
  of_one.pop_back();
  EXPECT_FALSE(limiter.Enter("robots/a").ok());
  EXPECT_THAT(limiter.Enter("robots/b"), IsOk());
}

}  // namespace
}  // namespace homing::server
