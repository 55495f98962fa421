// Maps of journeys that are being recorded: loaded when someone is to read them, and complete
// whatever is committed meanwhile.
#include "server/catalog/live_journey.h"

#include <functional>
#include <thread>
#include <utility>

#include "server/session/localization_session.h"
#include "tests/server/session/session_fixture.h"
#include "tests/support/forwarding_store.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;
using LoadResult = absl::StatusOr<JourneyMap>;

// Counts the loads; `next_load`, if set, takes the place of the next one.
class WatchedStore final : public storage::ForwardingStore {
 public:
  using ForwardingStore::ForwardingStore;
  LoadResult LoadMap(const std::string& name) override {
    ++loads;
    const auto load = std::exchange(next_load, nullptr);
    return load ? load() : store_->LoadMap(name);
  }

  std::function<LoadResult()> next_load;
  int loads = 0;
};

class LiveJourneyTest : public SessionTest {
 protected:
  void SetUp() override {
    StartOver();
    Create();
  }
  void TearDown() override {
    queue_.reset();
    catalog_.reset();
  }

  // As after a restart of the server.
  void StartOver() {
    queue_.reset();
    catalog_ = std::make_unique<JourneyCatalog>(&watched_);
    queue_ = std::make_unique<storage::CommitQueue>(&watched_);
  }

  void ExpectMapAsStored() {
    const LiveJourneys one = {catalog_->Open(kJourney).value()};
    const JourneyMap stored = store_->LoadMap(kJourney).value();
    const MapsLock lock(one);
    ExpectSameMap(one[0]->map(), stored);
    EXPECT_EQ(one[0]->map().settings(), stored.settings());
    EXPECT_EQ(one[0]->record().step_count, stored.step_count());
  }

  absl::StatusOr<std::unique_ptr<LocalizationSession>> Localise() {
    LocalizationQuery query;
    query.journey = kJourney;
    query.travel = Travel::kSame;
    return LocalizationSession::Open(catalog_.get(), query, {});
  }

  WatchedStore watched_{store_.get()};
};

TEST_F(LiveJourneyTest, RecordingLoadsNoMapAlsoAfterARestart) {
  RecordFlow(0, 20);
  StartOver();
  RecordFlow(20, 40);
  EXPECT_EQ(watched_.loads, 0);
  EXPECT_EQ(catalog_->Get(kJourney)->step_count, 40);
  ExpectMapAsStored();
  EXPECT_EQ(watched_.loads, 1);
  RecordFlow(40, 60);
  ExpectMapAsStored();
  EXPECT_EQ(watched_.loads, 1);
}

TEST_F(LiveJourneyTest, TakesLittleMemoryWithoutItsMap) {
  RecordFlow(0, 50);
  const auto claim = catalog_->Claim(kJourney, "writer", {}, [](const absl::Status&) {}).value();
  const std::int64_t without = claim.journey->MemoryBytes();
  ASSERT_EQ(catalog_->Open(kJourney).value(), claim.journey);
  EXPECT_LT(without, 4096);
  EXPECT_GT(claim.journey->MemoryBytes(),
            without + static_cast<std::int64_t>(50 * 2 * sizeof(FlowProfile)));
}

TEST_F(LiveJourneyTest, LocalisingMayBeginWhileTheJourneyIsRecorded) {
  Ear ear;
  const auto recording = Open(&ear).value();
  const auto record = [&](int first, int last) {
    for (int i = first; i < last; ++i) recording->Record(test::FlowAt(i), {});
    ear.AwaitAnswers(static_cast<std::size_t>(last) + 1);
  };
  record(0, 30);
  const auto homing = Localise().value();
  int sequence = 0;
  const auto expect_found = [&](int step) {
    const auto answer = homing->Localize(test::FlowAt(sequence++, step));
    ASSERT_THAT(answer, IsOk());
    ASSERT_FALSE(answer->matches.empty());
    EXPECT_EQ(answer->matches[0].step, step);
    EXPECT_DOUBLE_EQ(answer->matches[0].similarity.p_t, 1);
  };
  expect_found(5);
  expect_found(29);
  record(30, 60);
  expect_found(5);
  expect_found(35);
  expect_found(59);
}

TEST_F(LiveJourneyTest, StepsCommittedWhileTheMapIsLoadedCountOnce) {
  RecordFlow(0, 10);
  // Answered, though the load is not done: commits do not wait for it.
  watched_.next_load = [this]() -> LoadResult {
    RecordFlow(10, 20);
    LoadResult map = store_->LoadMap(kJourney);
    RecordFlow(20, 30);
    return map;
  };
  ExpectMapAsStored();
  EXPECT_EQ(watched_.loads, 1);
}

TEST_F(LiveJourneyTest, SettingsThatBecomeKnownWhileTheMapIsLoadedAreInIt) {
  watched_.next_load = [this]() -> LoadResult {
    LoadResult map = store_->LoadMap(kJourney);
    EXPECT_EQ(map->settings().cameras[0].width, 0);
    RecordFlow(0, 5);
    return map;
  };
  ExpectMapAsStored();
  EXPECT_EQ(catalog_->Get(kJourney)->settings.cameras[0].width, test::kWidth);
}

TEST_F(LiveJourneyTest, AFailedLoadReachesTheReaderAloneAndTheNextTrySucceeds) {
  RecordFlow(0, 10);
  watched_.next_load = [this]() -> LoadResult {
    RecordFlow(10, 20);
    return absl::UnavailableError("the disk does not answer");
  };
  EXPECT_THAT(Localise().status(),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("does not answer")));
  RecordFlow(20, 30);
  EXPECT_THAT(Localise(), IsOk());
  EXPECT_EQ(watched_.loads, 2);
  ExpectMapAsStored();
}

TEST_F(LiveJourneyTest, OneDeletedWhileItsMapIsLoadedIsNotFoundAlsoIfAnotherTookItsName) {
  RecordFlow(0, 10);
  watched_.next_load = [this]() -> LoadResult {
    EXPECT_THAT(catalog_->Delete(kJourney), IsOk());
    Create();
    RecordFlow(0, 5);
    return store_->LoadMap(kJourney);
  };
  EXPECT_THAT(catalog_->Open(kJourney).status(),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("deleted")));
  ExpectMapAsStored();
}

TEST_F(LiveJourneyTest, AWriterWhoseTailCannotBeReadGetsAnErrorAndMayRetry) {
  RecordFlow(0, 10);
  StartOver();
  class TaillessStore final : public storage::ForwardingStore {
   public:
    using ForwardingStore::ForwardingStore;
    absl::StatusOr<JourneyTail> LoadTail(const std::string& name) override {
      return std::exchange(failed_, true) ? store_->LoadTail(name)
                                          : absl::UnavailableError("the disk does not answer");
    }

   private:
    bool failed_ = false;
  } tailless(store_.get());
  JourneyCatalog catalog(&tailless);
  const RecordingContext context{&catalog, queue_.get(), {}};
  Ear ear;
  EXPECT_THAT(RecordingSession::Open(context, kJourney, "writer", {}, ear.Listener()).status(),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("does not answer")));
  EXPECT_THAT(RecordingSession::Open(context, kJourney, "writer", {}, ear.Listener()), IsOk());
  EXPECT_EQ(ear.AwaitAnswers(1)[0].next_sequence, 10);
}

// For ThreadSanitizer: several threads load a journey that is being recorded.
TEST_F(LiveJourneyTest, ReadersThatComeAtOnceFindAWholeMap) {
  constexpr int kSteps = 30;
  for (int round = 0; round < 5; ++round) {
    StartOver();
    std::thread writer([this, round] { RecordFlow(round * kSteps, (round + 1) * kSteps); });
    std::vector<std::thread> readers;
    for (int i = 0; i < 3; ++i) {
      readers.emplace_back([this, round] {
        const LiveJourneys one = {catalog_->Open(kJourney).value()};
        const MapsLock lock(one);
        EXPECT_GE(one[0]->map().step_count(), round * kSteps);
      });
    }
    writer.join();
    for (std::thread& reader : readers) reader.join();
    ExpectMapAsStored();
  }
  EXPECT_EQ(watched_.loads, 5);
}

}  // namespace
}  // namespace homing::server
