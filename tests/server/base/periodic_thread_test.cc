#include "server/base/periodic_thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>

namespace homing::server {
namespace {

TEST(PeriodicThreadTest, RepeatsTheRound) {
  std::promise<void> third;
  int rounds = 0;
  const PeriodicThread thread([&] {
    if (++rounds == 3) third.set_value();
    return std::chrono::milliseconds(1);
  });
  EXPECT_EQ(third.get_future().wait_for(std::chrono::seconds(10)), std::future_status::ready);
}

TEST(PeriodicThreadTest, EndsInTheMiddleOfAPauseAndCallsNoMore) {
  std::atomic<int> rounds = 0;
  {
    std::promise<void> first;
    const PeriodicThread thread([&] {
      if (++rounds == 1) first.set_value();
      return std::chrono::milliseconds(3'600'000);
    });
    first.get_future().wait();
  }
  EXPECT_EQ(rounds, 1);
}

}  // namespace
}  // namespace homing::server
