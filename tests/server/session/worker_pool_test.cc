#include "server/session/worker_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <vector>

namespace homing::server {
namespace {

TEST(WorkerPoolTest, RunsEverythingBeforeItEnds) {
  std::atomic<int> ran = 0;
  {
    WorkerPool pool(3);
    for (int i = 0; i < 200; ++i) {
      pool.Run([&ran] { ++ran; });
    }
  }
  EXPECT_EQ(ran, 200);
}

TEST(WorkerPoolTest, RefusesAboveItsBound) {
  std::promise<void> release;
  std::shared_future<void> released = release.get_future().share();
  std::promise<void> started;
  WorkerPool pool(1, 2);
  ASSERT_TRUE(pool.TryRun([&] {
    started.set_value();
    released.wait();
  }));
  started.get_future().wait();
  EXPECT_TRUE(pool.TryRun([] {}));
  EXPECT_TRUE(pool.TryRun([] {}));
  EXPECT_FALSE(pool.TryRun([] {}));
  release.set_value();
}

TEST(StrandTest, RunsInOrderAndOneAtATimeOnManyThreads) {
  constexpr int kStrands = 8;
  constexpr int kTasks = 300;
  std::vector<std::vector<int>> seen(kStrands);
  {
    WorkerPool pool(4);
    for (int s = 0; s < kStrands; ++s) {
      const auto strand = std::make_shared<Strand>(&pool);
      for (int i = 0; i < kTasks; ++i) {
        strand->Post([&order = seen[static_cast<std::size_t>(s)], i] { order.push_back(i); });
      }
    }
  }
  for (const std::vector<int>& order : seen) {
    ASSERT_EQ(order.size(), std::size_t{kTasks});
    for (int i = 0; i < kTasks; ++i) {
      EXPECT_EQ(order[static_cast<std::size_t>(i)], i);
    }
  }
}

}  // namespace
}  // namespace homing::server
