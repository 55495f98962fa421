// Queries over all journeys give the same answers by the index as by a scan of all maps, after any
// changes to the journeys.
#include "server/catalog/fleet_index.h"

#include <algorithm>
#include <thread>

#include "absl/strings/str_cat.h"
#include "homing/base/mutex.h"
#include "server/session/landmark_query.h"
#include "tests/server/session/session_fixture.h"
#include "tests/support/forwarding_store.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

// A store whose ListJourneys blocks until Release, and returns the status given there.
class HeldStore final : public storage::ForwardingStore {
 public:
  using ForwardingStore::ForwardingStore;
  void Release(absl::Status status) {
    const MutexLock lock(mutex_);
    released_ = std::move(status);
    changed_.NotifyAll();
  }

  absl::StatusOr<std::vector<storage::JourneyRecord>> ListJourneys(const std::string& prefix,
                                                                   const std::string& after,
                                                                   int limit) override {
    MutexLock lock(mutex_);
    while (!released_) changed_.Wait(mutex_);
    if (!released_->ok()) return *released_;
    return store_->ListJourneys(prefix, after, limit);
  }

 private:
  Mutex mutex_;
  ConditionVariable changed_;
  std::optional<absl::Status> released_;
};

class FleetIndexTest : public SessionTest {
 protected:
  // Gives the catalog an index, which is built from the journeys that `from` lists.
  void StartIndex(storage::JourneyStore* from) {
    queue_.reset();
    catalog_.reset();
    index_ = std::make_unique<FleetIndex>(from);
    catalog_ = std::make_unique<JourneyCatalog>(store_.get(), CatalogOptions{}, index_.get());
    queue_ = std::make_unique<storage::CommitQueue>(store_.get());
  }
  void AwaitReady() {
    while (!index_->CheckReady().ok()) std::this_thread::yield();
  }
  void TearDown() override {
    queue_.reset();
    catalog_.reset();
    index_.reset();
  }

  static LandmarkQuery QueryAt(int place) {
    LandmarkQuery query;
    query.journey = "robots/-/journeys/-";
    query.travel = Travel::kSame;
    const Observation observation = test::FlowAt(place);
    for (std::size_t side = 0; side < 2; ++side) {
      if (const auto* field = std::get_if<FlowField>(&observation.views[side])) {
        query.views[side] = *field;
      }
    }
    query.match.threshold = 0.01;
    query.match.max_matches = 50;
    return query;
  }

  // By the index, and by a catalog that has none.
  void ExpectSameAnswers() {
    JourneyCatalog plain(store_.get());
    std::size_t seen = 0;
    for (int place = 0; place < 25; ++place) {
      const auto found = LoadAndMatch(catalog_.get(), QueryAt(place));
      const auto scanned = LoadAndMatch(&plain, QueryAt(place));
      ASSERT_THAT(found, IsOk());
      ASSERT_THAT(scanned, IsOk());
      seen += scanned->matches.size();
      ASSERT_EQ(found->matches.size(), scanned->matches.size());
      for (std::size_t i = 0; i < found->matches.size(); ++i) {
        EXPECT_EQ(found->matches[i].journey, scanned->matches[i].journey);
        EXPECT_EQ(found->matches[i].match.landmark, scanned->matches[i].match.landmark);
        EXPECT_EQ(found->matches[i].match.step, scanned->matches[i].match.step);
        EXPECT_EQ(found->matches[i].match.side, scanned->matches[i].match.side);
        EXPECT_EQ(found->matches[i].match.similarity.p_t, scanned->matches[i].match.similarity.p_t);
      }
    }
    EXPECT_GT(seen, 20U);
  }

  void Record(const std::string& name, int steps) {
    Create(name);
    RecordFlow(0, steps, name);
  }

  std::unique_ptr<FleetIndex> index_;
};

TEST_F(FleetIndexTest, AnswersAsTheScanFromTheStore) {
  for (int i = 0; i < 4; ++i) Record(absl::StrCat("robots/r", i, "/journeys/j"), 10 + 5 * i);
  StartIndex(store_.get());
  AwaitReady();
  ExpectSameAnswers();
}

TEST_F(FleetIndexTest, KnowsAtOnceOfEveryStepAndDeletion) {
  Record("robots/r0/journeys/j", 10);
  StartIndex(store_.get());
  AwaitReady();
  Record("robots/r1/journeys/j", 20);
  ExpectSameAnswers();
  RecordFlow(10, 25, "robots/r0/journeys/j");
  ExpectSameAnswers();
  ASSERT_THAT(catalog_->Delete("robots/r1/journeys/j"), IsOk());
  ExpectSameAnswers();
  Record("robots/r1/journeys/j", 5);
  ExpectSameAnswers();
}

TEST_F(FleetIndexTest, KnowsOfAnImportedJourney) {
  Record("robots/r0/journeys/j", 10);
  StartIndex(store_.get());
  AwaitReady();
  auto map = store_->LoadMap("robots/r0/journeys/j");
  ASSERT_THAT(map, IsOk());
  storage::JourneyRecord record;
  record.name = "robots/r9/journeys/copy";
  record.settings = map->settings();
  record.next_sequence = map->step_count() + 1;
  ASSERT_THAT(catalog_->Import(record, *map), IsOk());
  ExpectSameAnswers();
}

TEST_F(FleetIndexTest, ChangesDuringTheBuildCountOnce) {
  Record("robots/r0/journeys/j", 10);
  Record("robots/r1/journeys/gone", 10);
  HeldStore held(store_.get());
  StartIndex(&held);
  RecordFlow(10, 15, "robots/r0/journeys/j");
  Record("robots/r2/journeys/new", 10);
  ASSERT_THAT(catalog_->Delete("robots/r1/journeys/gone"), IsOk());
  held.Release(absl::OkStatus());
  AwaitReady();
  ExpectSameAnswers();
  TearDown();
}

TEST_F(FleetIndexTest, UntilItIsReadyOnlyNamedJourneysAnswer) {
  Record("robots/r0/journeys/j", 10);
  HeldStore held(store_.get());
  StartIndex(&held);
  LandmarkQuery query = QueryAt(3);
  EXPECT_THAT(LoadAndMatch(catalog_.get(), query).status(),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("still being built")));
  query.journey = "robots/r0/journeys/j";
  EXPECT_THAT(LoadAndMatch(catalog_.get(), query), IsOk());
  held.Release(absl::OkStatus());
  AwaitReady();
  EXPECT_THAT(LoadAndMatch(catalog_.get(), QueryAt(3)), IsOk());
  TearDown();
}

TEST_F(FleetIndexTest, SaysWhyItCouldNotBeBuilt) {
  HeldStore held(store_.get());
  StartIndex(&held);
  held.Release(absl::DataLossError("the disk is gone"));
  while (index_->CheckReady().message().find("could not") == absl::string_view::npos) {
    std::this_thread::yield();
  }
  EXPECT_THAT(index_->CheckReady(),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("the disk is gone")));
  TearDown();
}

TEST_F(FleetIndexTest, WithoutJourneysThereIsNothingToFind) {
  StartIndex(store_.get());
  AwaitReady();
  EXPECT_THAT(LoadAndMatch(catalog_.get(), QueryAt(3)).status(),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("no journey")));
}

TEST_F(SessionTest, UnusedMapsAreEvicted) {
  for (int i = 0; i < 3; ++i) {
    const std::string name = absl::StrCat("robots/r", i, "/journeys/j");
    Create(name);
    RecordFlow(0, 5, name);
    ASSERT_THAT(catalog_->Finish(name, "writer", false, {}), IsOk());
  }
  JourneyCatalog small(store_.get(), CatalogOptions{.cache_bytes = 1});
  const auto used = *small.Open("robots/r0/journeys/j");
  const std::weak_ptr<LiveJourney> unused = *small.Open("robots/r1/journeys/j");
  ASSERT_THAT(small.Open("robots/r2/journeys/j"), IsOk());
  EXPECT_TRUE(unused.expired());
  EXPECT_EQ(*small.Open("robots/r0/journeys/j"), used);
}

TEST_F(SessionTest, AWildcardLoadsNoMoreMapsThanTheCacheHolds) {
  for (int i = 0; i < 3; ++i) {
    const std::string name = absl::StrCat("robots/r", i, "/journeys/j");
    Create(name);
    RecordFlow(0, 5, name);
    ASSERT_THAT(catalog_->Finish(name, "writer", false, {}), IsOk());
  }
  LandmarkQuery query;
  query.journey = "robots/-/journeys/-";
  query.travel = Travel::kSame;
  query.views[0] = test::FieldAt(2, Side::kLeft);
  EXPECT_THAT(LoadAndMatch(catalog_.get(), query), IsOk());
  // Room for one map and the journeys' records.
  JourneyCatalog small(store_.get(), CatalogOptions{.cache_bytes = 8000});
  EXPECT_THAT(LoadAndMatch(&small, query).status(),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("map-cache")));
  query.journey = "robots/r1/journeys/j";
  EXPECT_THAT(LoadAndMatch(&small, query), IsOk());
}

}  // namespace
}  // namespace homing::server
