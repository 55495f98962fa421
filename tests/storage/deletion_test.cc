// A long journey is deleted in pieces, and as a whole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "storage/connection.h"
#include "storage/doctor.h"
#include "tests/storage/store_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::storage {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

// More than a piece.
constexpr int kSteps = 10'000;

class DeletionTest : public ::testing::Test {
 protected:
  void SetUp() override {
    store_ = OpenOrDie(folder_.Database());
    StepMaker maker;
    ASSERT_THAT(store_->CreateJourney(Record(kJourney)), IsOk());
    for (int begin = 0; begin < kSteps; begin += 1000) {
      std::vector<JourneyAppend> appends;
      for (int i = 0; i < 1000; ++i) appends.push_back(AppendOf(kJourney, maker.Next()));
      ASSERT_THAT(store_->AppendSteps(appends)[999], IsOk());
    }
  }
  std::int64_t Count(const std::string& sql) {
    auto connection = OpenForReading(folder_.File("homing.db"), 1000);
    std::int64_t count = -1;
    EXPECT_THAT((*connection)->Run([&] {
      count = (*connection)->Integer(sql);
      return absl::OkStatus();
    }),
                IsOk());
    return count;
  }

  TemporaryFolder folder_;
  std::unique_ptr<JourneyStore> store_;
};

TEST_F(DeletionTest, ALongJourneyLeavesNothing) {
  ASSERT_EQ(Count("SELECT count(*) FROM steps"), kSteps);
  EXPECT_THAT(store_->DeleteJourney(kJourney), IsOk());
  EXPECT_EQ(Count("SELECT count(*) FROM steps"), 0);
  EXPECT_EQ(Count("SELECT count(*) FROM journeys"), 0);
  EXPECT_EQ(Count("SELECT count(*) FROM journey_settings"), 0);
  EXPECT_THAT(store_->DeleteJourney(kJourney),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr(kJourney)));
  ASSERT_THAT(store_->CreateJourney(Record(kJourney)), IsOk());
  EXPECT_EQ(store_->LoadMap(kJourney)->step_count(), 0);
}

TEST_F(DeletionTest, ADeletionThatACrashBrokeOffIsFinishedAtTheNextStart) {
  store_.reset();
  {
    const auto connection =
        Connection::Open(folder_.File("homing.db"), Connection::Access::kReadWrite, kBusyTimeoutMs);
    ASSERT_THAT(connection, IsOk());
    ASSERT_THAT((*connection)->Write([&] {
      (*connection)->Execute("UPDATE journeys SET name = 'deleted/' || journey_id, step_count = 0");
      return absl::OkStatus();
    }),
                IsOk());
  }
  const auto found = Examine(folder_.File("homing.db"));
  ASSERT_THAT(found, IsOk());
  EXPECT_TRUE(IsWhole(*found));
  EXPECT_THAT(found->journeys, IsEmpty());
  store_ = OpenOrDie(folder_.Database());
  EXPECT_EQ(Count("SELECT count(*) FROM steps"), 0);
  EXPECT_EQ(Count("SELECT count(*) FROM journeys"), 0);
}

}  // namespace
}  // namespace homing::storage
