#include "storage/commit_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <thread>

#include "tests/storage/store_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::storage {
namespace {

using ::testing::HasSubstr;

// Holds every transaction until it is released, and notes its size.
class HeldStore : public JourneyStore {
 public:
  std::vector<absl::Status> AppendSteps(const std::vector<JourneyAppend>& appends) override {
    batches.push_back(appends.size());
    entered.set_value();
    released.get_future().wait();
    entered = {};
    released = {};
    released.set_value();
    return std::vector<absl::Status>(appends.size(), result);
  }
  absl::Status CreateJourney(const JourneyRecord&) override { return result; }
  absl::StatusOr<JourneyRecord> GetJourney(const std::string&) override { return result; }
  absl::StatusOr<std::vector<JourneyRecord>> ListJourneys(const std::string&, const std::string&,
                                                          int) override {
    return result;
  }
  absl::Status DeleteJourney(const std::string&) override { return result; }
  absl::Status FinishJourney(const std::string&) override { return result; }
  absl::StatusOr<AcquiredJourney> AcquireJourney(const std::string&, const std::string&) override {
    return result;
  }
  absl::StatusOr<JourneyGrowth> LoadSteps(const std::string&, std::int64_t) override {
    return result;
  }
  absl::StatusOr<std::vector<JourneyMark>> LoadMarks(const std::vector<std::string>&) override {
    return result;
  }
  absl::Status SetReaders(const std::string&, const std::vector<std::string>&) override {
    return result;
  }
  absl::StatusOr<JourneyMap> LoadMap(const std::string&) override { return result; }
  absl::StatusOr<JourneyTail> LoadTail(const std::string&) override { return result; }
  absl::Status ImportJourney(const JourneyRecord&, const JourneyMap&) override { return result; }
  absl::Status CreateModel(const StoredModel&) override { return result; }
  absl::StatusOr<StoredModel> GetModel(const std::string&) override { return result; }
  absl::StatusOr<std::vector<StoredModel>> ListModels(const std::string&, int) override {
    return result;
  }

  std::promise<void> entered;
  std::promise<void> released;
  std::vector<std::size_t> batches;
  absl::Status result = absl::UnavailableError("held");
};

TEST(CommitQueue, CallsBackOnlyAfterTheCommitInOrderOfSubmission) {
  const TemporaryFolder folder;
  auto store = OpenOrDie(folder.Database());
  ASSERT_THAT(store->CreateJourney(Record("j")), IsOk());
  const std::vector<JourneyStep> steps = MakeSteps(100);
  std::vector<std::int64_t> order;
  std::atomic<int> early = 0;
  int reported = 0;
  {
    CommitQueueOptions options;
    options.on_commit = [&](int stored, bool ok, std::chrono::duration<double> /*time*/) {
      reported += ok ? stored : -1000;
    };
    CommitQueue queue(store.get(), options);
    for (const JourneyStep& step : steps) {
      ASSERT_THAT(
          queue.Submit(
              AppendOf("j", step),
              [&, sequence = step.step](const JourneyAppend& append, const absl::Status& status) {
                if (append.sequence != sequence) ++early;
                order.push_back(sequence);
                if (!status.ok() || store->GetJourney("j")->next_sequence <= sequence) {
                  ++early;
                }
              }),
          IsOk());
    }
  }
  EXPECT_EQ(early, 0);
  EXPECT_EQ(reported, 100);
  ASSERT_EQ(order.size(), steps.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    EXPECT_EQ(order[i], static_cast<std::int64_t>(i));
  }
  EXPECT_TRUE(SameMap(*store->LoadMap("j"), MapOf(OddSettings(), steps)));
}

TEST(CommitQueue, GroupsWaitingAppendsRefusesTheRestAndDrains) {
  HeldStore store;
  int called = 0;
  absl::Status last;
  const auto done = [&](const JourneyAppend&, absl::Status status) {
    ++called;
    last = std::move(status);
  };
  {
    CommitQueue queue(&store, {.max_pending = 5, .max_batch = 3});
    std::future<void> entered = store.entered.get_future();
    ASSERT_THAT(queue.Submit(JourneyAppend(), done), IsOk());
    entered.wait();
    for (int i = 0; i < 5; ++i) ASSERT_THAT(queue.Submit(JourneyAppend(), done), IsOk());
    EXPECT_THAT(queue.Submit(JourneyAppend(), done),
                StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("at most 5")));
    EXPECT_EQ(called, 0);
    store.released.set_value();
  }
  EXPECT_EQ(called, 6);
  EXPECT_THAT(store.batches, ::testing::ElementsAre(1, 3, 2));
  EXPECT_THAT(last, StatusIs(absl::StatusCode::kUnavailable, HasSubstr("held")));
}

TEST(CommitQueue, AfterALargeBatchItWaitsForMore) {
  HeldStore store;
  std::atomic<int> called = 0;
  const auto done = [&](const JourneyAppend&, const absl::Status&) { ++called; };
  {
    CommitQueue queue(&store,
                      {.busy_batch = 1, .full_batch = 2, .gather_time = std::chrono::hours(1)});
    store.released.set_value();
    ASSERT_THAT(queue.Submit(JourneyAppend(), done), IsOk());
    while (called < 1) std::this_thread::yield();
    ASSERT_THAT(queue.Submit(JourneyAppend(), done), IsOk());
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_EQ(called, 1);
    ASSERT_THAT(queue.Submit(JourneyAppend(), done), IsOk());
    while (called < 3) std::this_thread::yield();
    // Waiting appends are committed at once at the end.
    ASSERT_THAT(queue.Submit(JourneyAppend(), done), IsOk());
  }
  EXPECT_EQ(called, 4);
  EXPECT_THAT(store.batches, ::testing::ElementsAre(1, 2, 1));
}

TEST(CommitQueue, ManyThreadsMaySubmit) {
  const TemporaryFolder folder;
  auto store = OpenOrDie(folder.Database());
  constexpr int kJourneys = 4;
  std::atomic<int> failed = 0;
  {
    CommitQueue queue(store.get());
    std::vector<std::thread> robots;
    for (int j = 0; j < kJourneys; ++j) {
      ASSERT_THAT(store->CreateJourney(Record("j" + std::to_string(j))), IsOk());
      robots.emplace_back([&, j] {
        for (const JourneyStep& step : MakeSteps(50)) {
          const auto count = [&](const JourneyAppend&, const absl::Status& status) {
            failed += status.ok() ? 0 : 1;
          };
          if (!queue.Submit(AppendOf("j" + std::to_string(j), step), count).ok()) ++failed;
        }
      });
    }
    for (std::thread& robot : robots) robot.join();
  }
  EXPECT_EQ(failed, 0);
  for (int j = 0; j < kJourneys; ++j) {
    EXPECT_EQ(store->GetJourney("j" + std::to_string(j))->next_sequence, 50);
  }
}

}  // namespace
}  // namespace homing::storage
