#include "server/http/login_limit.h"

#include <gtest/gtest.h>

namespace homing::server {
namespace {

TEST(LoginLimitTest, AnAddressMayTryAgainAMinuteLater) {
  LoginLimit limit;
  const LoginLimit::Time now;
  for (int i = 0; i < LoginLimit::kMostFailures; ++i) {
    EXPECT_TRUE(limit.MayFail("1.2.3.4", now));
  }
  EXPECT_FALSE(limit.MayFail("1.2.3.4", now));
  EXPECT_TRUE(limit.MayFail("1.2.3.5", now));
  EXPECT_TRUE(limit.MayFail("1.2.3.4", now + LoginLimit::kPeriod));
  for (int i = 0; i < 20'000; ++i) limit.MayFail(std::to_string(i), now);
  EXPECT_FALSE(limit.MayFail("one more", now));
  EXPECT_TRUE(limit.MayFail("one more", now + LoginLimit::kPeriod));
}

}  // namespace
}  // namespace homing::server
