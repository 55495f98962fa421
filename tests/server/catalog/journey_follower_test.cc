// Two servers on one store: what one does to a journey, the other one sees.
#include "server/catalog/journey_follower.h"

#include <chrono>
#include <thread>

#include "tests/server/session/session_fixture.h"
#include "tests/support/forwarding_store.h"

namespace homing::server {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

class SharedStore final : public storage::ForwardingStore {
 public:
  using ForwardingStore::ForwardingStore;
  bool shared() const override { return true; }
};

// The fixture's catalog is one server; `other_` is another one, which follows.
class JourneyFollowerTest : public SessionTest {
 protected:
  void SetUp() override {
    catalog_ = std::make_unique<JourneyCatalog>(&shared_);
    Create();
  }
  void TearDown() override {
    follower_.reset();
    queue_.reset();
    catalog_.reset();
  }

  // As a localising stream sees it.
  std::int64_t StepsInOther() {
    const LiveJourneys one = {other_.Open(kJourney).value()};
    const MapsLock lock(one);
    return one[0]->map().step_count();
  }
  // Waits until `holds`, for as long as a robot may be kept waiting.
  template <typename Condition>
  static bool Soon(Condition holds) {
    for (const auto end = std::chrono::steady_clock::now() + milliseconds(500);
         std::chrono::steady_clock::now() < end;) {
      if (holds()) return true;
      std::this_thread::sleep_for(milliseconds(5));
    }
    return holds();
  }

  SharedStore shared_{store_.get()};
  JourneyCatalog other_{&shared_};
  std::unique_ptr<JourneyFollower> follower_ = std::make_unique<JourneyFollower>(&shared_, &other_);
};

TEST_F(JourneyFollowerTest, NewStepsAreInTheMapOfTheOtherServerWithinHalfASecond) {
  RecordFlow(0, 20);
  EXPECT_EQ(StepsInOther(), 20);
  RecordFlow(20, 45);
  EXPECT_TRUE(Soon([&] { return StepsInOther() == 45; }));
  EXPECT_EQ(other_.Get(kJourney)->next_sequence, 45);
  const LiveJourneys one = {other_.Open(kJourney).value()};
  const JourneyMap stored = store_->LoadMap(kJourney).value();
  const MapsLock lock(one);
  ExpectSameMap(one[0]->map(), stored);
}

TEST_F(JourneyFollowerTest, AWriterThatGoesToTheOtherServerEndsItsOldStream) {
  JourneyFollower own(&shared_, catalog_.get());
  RecordFlow(0, 5);
  Ear ear;
  const auto session = Open(&ear);
  ASSERT_THAT(session, IsOk());
  const auto claim = other_.Claim(kJourney, "writer", {}, nullptr);
  ASSERT_THAT(claim, IsOk());
  EXPECT_EQ(claim->journey->record().next_sequence, 5);
  EXPECT_THAT(ear.AwaitEnd(), StatusIs(absl::StatusCode::kAborted, HasSubstr("taken over")));
}

TEST_F(JourneyFollowerTest, AStaleStreamStoresNothingEvenBeforeItIsTold) {
  Ear ear;
  const auto session = Open(&ear);
  ASSERT_THAT(session, IsOk());
  ASSERT_THAT(other_.Claim(kJourney, "writer", {}, nullptr), IsOk());
  (*session)->Record(test::FlowAt(0), {});
  EXPECT_THAT(ear.AwaitEnd(), StatusIs(absl::StatusCode::kAborted, HasSubstr("taken over")));
  EXPECT_EQ(store_->GetJourney(kJourney)->next_sequence, 0);
}

TEST_F(JourneyFollowerTest, AJourneyThatTheOtherServerFinishesEndsItsStream) {
  JourneyFollower own(&shared_, catalog_.get());
  Ear ear;
  const auto session = Open(&ear);
  ASSERT_THAT(session, IsOk());
  ASSERT_THAT(other_.Finish(kJourney, "writer", false, {}), IsOk());
  EXPECT_THAT(ear.AwaitEnd(),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("finished")));
}

TEST_F(JourneyFollowerTest, AJourneyThatIsDeletedAndMadeAgainElsewhereIsTheNewOne) {
  RecordFlow(0, 20);
  const std::shared_ptr<LiveJourney> old = other_.Open(kJourney).value();
  ASSERT_THAT(catalog_->Delete(kJourney), IsOk());
  EXPECT_TRUE(Soon([&] { return old->deleted(); }));
  EXPECT_THAT(other_.Open(kJourney), StatusIs(absl::StatusCode::kNotFound, HasSubstr(kJourney)));
  Create();
  EXPECT_EQ(StepsInOther(), 0);
}

TEST_F(JourneyFollowerTest, AClaimCatchesUpWithWhatWasRecordedElsewhere) {
  RecordFlow(0, 10);
  EXPECT_EQ(StepsInOther(), 10);
  follower_.reset();
  RecordFlow(10, 30);
  const auto claim = other_.Claim(kJourney, "writer", {}, nullptr);
  ASSERT_THAT(claim, IsOk());
  EXPECT_EQ(claim->journey->record().next_sequence, 30);
  EXPECT_EQ(StepsInOther(), 30);
}

}  // namespace
}  // namespace homing::server
