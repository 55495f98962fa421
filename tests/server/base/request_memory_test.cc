#include "server/base/request_memory.h"

#include <gtest/gtest.h>

#include <memory>

namespace homing::server {
namespace {

using Share = RequestMemory::Share;

TEST(RequestMemoryTest, ACallerHasAQuarter) {
  const auto memory = std::make_shared<RequestMemory>(100);
  Share one(memory, "a");
  EXPECT_TRUE(one.TrySet(20));
  {
    Share two(memory, "a");
    EXPECT_FALSE(two.TrySet(6));
    EXPECT_TRUE(two.TrySet(5));
  }
  Share other(memory, "b");
  EXPECT_TRUE(other.TrySet(25));
  Share three(memory, "a");
  EXPECT_TRUE(three.TrySet(5));
  EXPECT_TRUE(one.TrySet(0));
  EXPECT_TRUE(three.TrySet(25));
}

TEST(RequestMemoryTest, TheOnlyRequestOfACallerMayBeLarger) {
  const auto memory = std::make_shared<RequestMemory>(100);
  Share one(memory, "a");
  EXPECT_TRUE(one.TrySet(60));
  Share two(memory, "b");
  EXPECT_FALSE(two.TrySet(41));
  EXPECT_TRUE(two.TrySet(40));
  Share three(memory, "c");
  EXPECT_FALSE(three.TrySet(1));
  EXPECT_TRUE(two.TrySet(0));
  EXPECT_TRUE(three.TrySet(1));
}

TEST(RequestMemoryTest, ARequestBeyondTheWholeIsTakenAlone) {
  const auto memory = std::make_shared<RequestMemory>(100);
  Share one(memory, "a");
  EXPECT_TRUE(one.TrySet(150));
  Share two(memory, "b");
  EXPECT_FALSE(two.TrySet(1));
}

TEST(RequestMemoryTest, ZeroIsNoLimit) {
  const auto memory = std::make_shared<RequestMemory>(0);
  Share one(memory, "a");
  Share two(memory, "a");
  EXPECT_TRUE(one.TrySet(std::int64_t{1} << 40));
  EXPECT_TRUE(two.TrySet(std::int64_t{1} << 40));
}

}  // namespace
}  // namespace homing::server
