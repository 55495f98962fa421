#include "server/base/worker_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <string>
#include <thread>
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

// Keeps the only thread of `pool` busy until Release.
class Blocker {
 public:
  explicit Blocker(WorkerPool* pool) {
    pool->Run([this, released = release_.get_future().share()] {
      started_.set_value();
      released.wait();
    });
    started_.get_future().wait();
  }
  void Release() { release_.set_value(); }

 private:
  std::promise<void> release_;
  std::promise<void> started_;
};

TEST(WorkerPoolTest, CallersTakeTurns) {
  std::string order;
  {
    WorkerPool pool(1);
    Blocker blocker(&pool);
    for (const char* task : {"a1", "a2", "a3", "b1", "b2", "c1"}) {
      pool.Run([&order, task] { order += task; }, std::string(1, task[0]));
    }
    blocker.Release();
  }
  EXPECT_EQ(order, "a1b1c1a2b2a3");
}

TEST(WorkerPoolTest, ACallerThatFillsItDoesNotShutOthersOut) {
  WorkerPool pool(1, 2);
  Blocker blocker(&pool);
  EXPECT_TRUE(pool.TryRun([] {}, "greedy"));
  EXPECT_TRUE(pool.TryRun([] {}, "greedy"));
  EXPECT_FALSE(pool.TryRun([] {}, "greedy"));
  EXPECT_TRUE(pool.TryRun([] {}, "other"));
  EXPECT_FALSE(pool.TryRun([] {}, "other"));
  blocker.Release();
}

TEST(StrandTest, TheStreamsOfACallerTakeOneTurnTogether) {
  std::string order;
  {
    WorkerPool pool(1);
    Blocker blocker(&pool);
    std::vector<std::shared_ptr<Strand>> strands;
    for (const char* caller : {"a", "a", "a", "b"}) {
      strands.push_back(std::make_shared<Strand>(&pool, caller));
      strands.back()->Post([&order, caller] { order += caller; });
    }
    blocker.Release();
  }
  EXPECT_EQ(order, "abaa");
}

TEST(StrandTest, RunsOnTheCallersThreadWhenNothingElseRunsOrWaits) {
  WorkerPool pool(1);
  const auto strand = std::make_shared<Strand>(&pool);
  std::thread::id here;
  strand->RunOrPost([&] { here = std::this_thread::get_id(); });
  EXPECT_EQ(here, std::this_thread::get_id());
}

TEST(StrandTest, TasksPostedDuringAnInlineTaskWaitForItsEnd) {
  std::vector<int> order;
  {
    WorkerPool pool(2);
    const auto strand = std::make_shared<Strand>(&pool);
    strand->RunOrPost([&] {
      strand->Post([&] { order.push_back(1); });
      strand->RunOrPost([&] { order.push_back(2); });
      order.push_back(0);
    });
  }
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2}));
}

TEST(WorkerPoolTest, RunsOnTheCallersThreadOnceStopped) {
  WorkerPool pool(1);
  pool.Stop();
  std::thread::id here;
  pool.Run([&] { here = std::this_thread::get_id(); });
  EXPECT_EQ(here, std::this_thread::get_id());
}

TEST(StrandTest, AStreamDoesNotHoldUpAnotherOneForLong) {
  std::vector<int> order;
  {
    std::promise<void> release;
    WorkerPool pool(1);
    pool.Run([released = release.get_future().share()] { released.wait(); });
    const auto busy = std::make_shared<Strand>(&pool);
    const auto other = std::make_shared<Strand>(&pool);
    for (int i = 0; i < 4; ++i) {
      busy->Post([&order] {
        std::this_thread::sleep_for(std::chrono::milliseconds(3));
        order.push_back(0);
      });
    }
    other->Post([&order] { order.push_back(1); });
    release.set_value();
  }
  EXPECT_EQ(order, (std::vector<int>{0, 1, 0, 0, 0}));
}

TEST(StrandTest, KeepsTheOrderAcrossPools) {
  std::vector<int> order;
  {
    WorkerPool first(2);
    WorkerPool second(2);
    const auto strand = std::make_shared<Strand>(&first);
    for (int i = 0; i < 100; ++i) {
      strand->PostTo(i % 3 == 0 ? &second : &first, [&order, i] { order.push_back(i); });
    }
    second.Stop();
    first.Stop();
  }
  ASSERT_EQ(order.size(), 100U);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(order[static_cast<std::size_t>(i)], i);
}

TEST(StrandTest, ATaskThatWaitsInAnotherPoolLeavesThisOneFree) {
  std::promise<void> release;
  std::promise<void> ran;
  WorkerPool waiting(1);
  WorkerPool pool(1);
  const auto one = std::make_shared<Strand>(&pool);
  const auto two = std::make_shared<Strand>(&pool);
  one->PostTo(&waiting, [released = release.get_future().share()] { released.wait(); });
  one->Post([] {});
  two->Post([&] { ran.set_value(); });
  ran.get_future().wait();
  release.set_value();
  waiting.Stop();
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
        const auto task = [&order = seen[static_cast<std::size_t>(s)], i] { order.push_back(i); };
        if (i % 3 == 0) {
          strand->RunOrPost(task);
        } else {
          strand->Post(task);
        }
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
