// Fencing of writers, and what keeps a journey in memory like the stored one, on every kind of
// store.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/storage/store_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::storage {
namespace {

using ::testing::HasSubstr;

class AcquireTest : public EveryStore {
 protected:
  void SetUp() override {
    EveryStore::SetUp();
    if (IsSkipped()) return;
    ASSERT_THAT(store_->CreateJourney(Record(kJourney)), IsOk());
  }

  absl::Status Append(const JourneyAppend& append) { return store_->AppendSteps({append})[0]; }
};

TEST_P(AcquireTest, AWriterThatWasReplacedWritesNothing) {
  const std::vector<JourneyStep> steps = MakeSteps(4);
  JourneyAppend append = AppendOf(kJourney, steps[0]);
  const auto first = store_->AcquireJourney(kJourney, "one");
  ASSERT_THAT(first, IsOk());
  EXPECT_EQ(first->record.next_sequence, 0);
  EXPECT_THAT(Append(append), StatusIs(absl::StatusCode::kAborted, HasSubstr("taken over")));
  append.epoch = first->epoch;
  ASSERT_THAT(Append(append), IsOk());
  const auto second = store_->AcquireJourney(kJourney, "one");
  ASSERT_THAT(second, IsOk());
  EXPECT_GT(second->epoch, first->epoch);
  EXPECT_EQ(second->record.next_sequence, 1);
  append = AppendOf(kJourney, steps[1]);
  append.epoch = first->epoch;
  EXPECT_THAT(Append(append), StatusIs(absl::StatusCode::kAborted, HasSubstr(kJourney)));
  EXPECT_EQ(store_->GetJourney(kJourney)->next_sequence, 1);
  append.epoch = second->epoch;
  EXPECT_THAT(Append(append), IsOk());
}

TEST_P(AcquireTest, AnEpochIsNotUsedAgainForAJourneyOfTheSameName) {
  const std::int64_t epoch = store_->AcquireJourney(kJourney, "one").value().epoch;
  ASSERT_THAT(store_->DeleteJourney(kJourney), IsOk());
  ASSERT_THAT(store_->CreateJourney(Record(kJourney)), IsOk());
  EXPECT_GT(store_->AcquireJourney(kJourney, "one").value().epoch, epoch);
}

TEST_P(AcquireTest, AFinishedJourneyIsNotAcquired) {
  ASSERT_THAT(store_->FinishJourney(kJourney), IsOk());
  EXPECT_THAT(store_->AcquireJourney(kJourney, "one"),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("finished")));
}

TEST_P(AcquireTest, LoadsTheStepsFromOneOnAndMarksOfWhatIsThere) {
  const std::vector<JourneyStep> steps = WithProfiles(MakeSteps(12));
  const std::int64_t epoch = store_->AcquireJourney(kJourney, "one").value().epoch;
  for (const JourneyStep& step : steps) {
    JourneyAppend append = AppendOf(kJourney, step);
    append.epoch = epoch;
    ASSERT_THAT(Append(append), IsOk());
  }
  const auto growth = store_->LoadSteps(kJourney, 9);
  ASSERT_THAT(growth, IsOk());
  EXPECT_EQ(growth->record.next_sequence, 12);
  ASSERT_EQ(growth->steps.size(), 3U);
  EXPECT_EQ(growth->steps[0].step, 9);
  EXPECT_EQ(growth->steps[2].fingerprints, steps[11].fingerprints);
  EXPECT_EQ(growth->steps[2].profiles, steps[11].profiles);
  EXPECT_TRUE(store_->LoadSteps(kJourney, kMostSteps)->steps.empty());
  const auto marks = store_->LoadMarks({kJourney, "robots/r/journeys/none"});
  ASSERT_THAT(marks, IsOk());
  ASSERT_EQ(marks->size(), 1U);
  EXPECT_EQ(marks->at(0).name, kJourney);
  EXPECT_EQ(marks->at(0).next_sequence, 12);
  EXPECT_EQ(marks->at(0).epoch, epoch);
  EXPECT_EQ(marks->at(0).state, JourneyState::kActive);
}

INSTANTIATE_TEST_SUITE_P(Stores, AcquireTest, EveryKind(), KindName);

}  // namespace
}  // namespace homing::storage
