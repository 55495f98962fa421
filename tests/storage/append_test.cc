// Steps appended, loaded, imported and deleted, on every kind of store.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <thread>

#include "tests/storage/store_fixture.h"
#include "tests/support/journey_tail.h"
#include "tests/support/status_matchers.h"

namespace homing::storage {
namespace {

using ::testing::HasSubstr;

constexpr char kOther[] = "robots/r/journeys/k";

class AppendTest : public EveryStore {
 protected:
  void SetUp() override {
    EveryStore::SetUp();
    if (IsSkipped()) return;
    ASSERT_THAT(store_->CreateJourney(Record(kJourney)), IsOk());
  }

  absl::Status Append(const JourneyAppend& append) { return store_->AppendSteps({append})[0]; }
  // The steps of a journey that `step` follows are stored; `step` is refused, and nothing of it
  // stays.
  void ExpectRefused(const JourneyStep& step, const std::string& why) {
    const JourneyMap before = *store_->LoadMap(kJourney);
    JourneyAppend append = AppendOf(kJourney, step);
    append.sequence = store_->GetJourney(kJourney)->next_sequence;
    EXPECT_THAT(Append(append), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(why)));
    EXPECT_TRUE(SameMap(*store_->LoadMap(kJourney), before));
    EXPECT_EQ(store_->GetJourney(kJourney)->next_sequence, append.sequence);
  }
};

TEST_P(AppendTest, LoadsTheVeryMapThatTheStepsMake) {
  const std::vector<JourneyStep> steps = MakeSteps(200);
  AppendAll(*store_, kJourney, steps);
  const auto map = store_->LoadMap(kJourney);
  ASSERT_THAT(map, IsOk());
  const JourneyMap expected = MapOf(OddSettings(), steps);
  EXPECT_TRUE(SameMap(*map, expected));
  const auto record = store_->GetJourney(kJourney);
  EXPECT_EQ(record->step_count, 200);
  EXPECT_EQ(record->next_sequence, 200);
  EXPECT_EQ(record->landmark_count, static_cast<int>(expected.landmarks().size()));
  EXPECT_EQ(record->fingerprint_count,
            static_cast<std::int64_t>(expected.all_fingerprints().size()));
  EXPECT_EQ(record->input, InputKind::kFlowVectors);
  EXPECT_EQ(record->start_time_ns, 1'000'000'000);
  EXPECT_EQ(record->end_time_ns, 1'000'000'199);
}

TEST_P(AppendTest, LoadsTheFlowProfilesThatWereAppended) {
  const std::vector<JourneyStep> steps = WithProfiles(MakeSteps(50));
  AppendAll(*store_, kJourney, steps);
  const JourneyMap expected = MapOf(OddSettings(), steps);
  ASSERT_EQ(expected.profiles(Side::kLeft).size(), 50U);
  const auto map = store_->LoadMap(kJourney);
  ASSERT_THAT(map, IsOk());
  EXPECT_TRUE(SameMap(*map, expected));
  // Another journey of the same store has its own.
  EXPECT_THAT(store_->CreateJourney(Record(kOther)), IsOk());
  AppendAll(*store_, kOther, MakeSteps(50));
  EXPECT_TRUE(store_->LoadMap(kOther)->profiles(Side::kLeft).empty());
  EXPECT_TRUE(SameMap(*store_->LoadMap(kJourney), expected));
}

// As far as they count in a tail.
std::vector<JourneyStep> NumbersAndFingerprints(std::vector<JourneyStep> steps) {
  std::erase_if(steps, [](const JourneyStep& step) { return step.fingerprints.empty(); });
  for (JourneyStep& step : steps) {
    step.profiles = {};
    for (RecordedFingerprint& recorded : step.fingerprints) recorded.spread = 0;
  }
  return steps;
}

TEST_P(AppendTest, TheTailIsThatOfTheMapAtEveryLength) {
  EXPECT_THAT(store_->CreateJourney(Record(kOther)), IsOk());
  AppendAll(*store_, kOther, MakeSteps(5));
  std::vector<JourneyStep> steps = WithProfiles(MakeSteps(30));
  steps[20].fingerprints.clear();
  for (std::size_t count = 0; count <= steps.size(); ++count) {
    if (count > 0) AppendAll(*store_, kJourney, {steps[count - 1]});
    const JourneyTail expected = test::TailOf(*store_->LoadMap(kJourney));
    const auto tail = store_->LoadTail(kJourney);
    ASSERT_THAT(tail, IsOk());
    EXPECT_EQ(tail->step_count, static_cast<std::int64_t>(count));
    EXPECT_EQ(tail->landmark_count, expected.landmark_count);
    EXPECT_EQ(NumbersAndFingerprints(tail->steps), expected.steps);
  }
  EXPECT_THAT(store_->LoadTail("none"), StatusIs(absl::StatusCode::kNotFound, HasSubstr("none")));
}

TEST_P(AppendTest, AnObservationWithoutAStepMakesItsNumberDurable) {
  JourneyAppend first;
  first.journey = kJourney;
  first.capture_time_ns = 5;
  ASSERT_THAT(Append(first), IsOk());
  EXPECT_EQ(store_->GetJourney(kJourney)->next_sequence, 1);
  EXPECT_EQ(store_->GetJourney(kJourney)->step_count, 0);
  EXPECT_EQ(store_->GetJourney(kJourney)->start_time_ns, 0);
}

TEST_P(AppendTest, StepsWithoutFingerprintsAndSkippedStepsCount) {
  JourneyStep standing;
  standing.motion = Motion::kStanding;
  AppendAll(*store_, kJourney, {standing});
  for (std::int64_t sequence = 1; sequence < 3; ++sequence) {
    JourneyAppend none;
    none.journey = kJourney;
    none.sequence = sequence;
    ASSERT_THAT(Append(none), IsOk());
  }
  JourneyStep third = MakeSteps(1)[0];
  third.step = 3;
  AppendAll(*store_, kJourney, {third});
  const auto map = store_->LoadMap(kJourney);
  ASSERT_THAT(map, IsOk());
  EXPECT_EQ(map->step_count(), 4);
  EXPECT_TRUE(map->fingerprints(2).empty());
  EXPECT_EQ(map->fingerprints(3).size(), 2U);
  EXPECT_EQ(map->landmarks()[0].first_step, 3);
}

TEST_P(AppendTest, SettingsComeWithTheStepThatMadeThemKnown) {
  JourneyAppend append = AppendOf(kJourney, MakeSteps(1)[0]);
  append.settings = OddSettings();
  append.settings->cameras[1].width = 1280;
  ASSERT_THAT(Append(append), IsOk());
  EXPECT_TRUE(store_->GetJourney(kJourney)->settings == *append.settings);
  EXPECT_TRUE(store_->LoadMap(kJourney)->settings() == *append.settings);
}

TEST_P(AppendTest, OneTransactionServesManyJourneysAndRefusesOnlyTheWrongEntries) {
  ASSERT_THAT(store_->CreateJourney(Record(kOther)), IsOk());
  ASSERT_THAT(store_->CreateJourney(Record("finished")), IsOk());
  ASSERT_THAT(store_->FinishJourney("finished"), IsOk());
  const std::vector<JourneyStep> steps = MakeSteps(3);
  const auto statuses = store_->AppendSteps(
      {AppendOf(kJourney, steps[0]), AppendOf("gone", steps[0]), AppendOf(kOther, steps[0]),
       AppendOf("finished", steps[0]), AppendOf(kJourney, steps[2]), AppendOf(kJourney, steps[1]),
       AppendOf(kOther, steps[0])});
  ASSERT_EQ(statuses.size(), 7U);
  EXPECT_THAT(statuses[0], IsOk());
  EXPECT_THAT(statuses[1], StatusIs(absl::StatusCode::kNotFound, HasSubstr("gone")));
  EXPECT_THAT(statuses[2], IsOk());
  EXPECT_THAT(statuses[3], StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("finished")));
  EXPECT_THAT(statuses[4], StatusIs(absl::StatusCode::kOutOfRange, HasSubstr("must be 1")));
  EXPECT_THAT(statuses[5], IsOk());
  EXPECT_THAT(statuses[6], StatusIs(absl::StatusCode::kOutOfRange, HasSubstr("must be 1")));
  EXPECT_EQ(store_->GetJourney(kJourney)->next_sequence, 2);
  EXPECT_EQ(store_->GetJourney(kOther)->next_sequence, 1);
}

TEST_P(AppendTest, RefusesAnotherKindOfInput) {
  const std::vector<JourneyStep> steps = MakeSteps(2);
  AppendAll(*store_, kJourney, {steps[0]});
  JourneyAppend append = AppendOf(kJourney, steps[1]);
  append.input = InputKind::kFrames;
  EXPECT_THAT(Append(append),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("FLOW_VECTORS")));
}

TEST_P(AppendTest, RefusesStepsThatTheMapWouldRefuse) {
  const std::vector<JourneyStep> steps = MakeSteps(12);
  AppendAll(*store_, kJourney, {steps.begin(), steps.begin() + 11});
  const JourneyStep& good = steps[11];
  ASSERT_EQ(good.fingerprints.size(), 4U);
  const auto refused = [&](auto change, const std::string& why) {
    JourneyStep bad = good;
    change(bad);
    JourneyMap map = MapOf(OddSettings(), {steps.begin(), steps.begin() + 11});
    EXPECT_FALSE(bad.step <= 11 && map.Append(bad).ok()) << why;
    ExpectRefused(bad, why);
  };
  refused([](JourneyStep& s) { s.step = 10; }, "step: 10 must be in [11, 11]");
  refused([](JourneyStep& s) { s.step = 12; }, "step: 12 must be in [11, 11]");
  refused([](JourneyStep& s) { s.fingerprints[3].fingerprint.landmark = 1000; }, "landmark: 1000");
  refused([](JourneyStep& s) { s.fingerprints[1].fingerprint.landmark = -1; }, "landmark: -1");
  refused([](JourneyStep& s) { s.fingerprints[1] = s.fingerprints[0]; }, "once in a step");
  refused([](JourneyStep& s) { s.fingerprints[0].fingerprint.count = 0; }, "0 must be at least 1");
  refused([](JourneyStep& s) { s.fingerprints[0].fingerprint.x = NAN; }, "finite");
  refused([](JourneyStep& s) { s.fingerprints[0].spread = INFINITY; }, "spread");
  refused([](JourneyStep& s) { std::swap(s.fingerprints[1], s.fingerprints[2]); }, "left");
  refused([](JourneyStep& s) { s.fingerprints[1].side = Side::kRight; }, "side");
  refused([](JourneyStep& s) { s.fingerprints.push_back(s.fingerprints[3]); }, "at most 2");
  AppendAll(*store_, kJourney, {good});
}

TEST_P(AppendTest, ALandmarkMustHaveTheSideOfItsLastStepHoweverLongAgo) {
  std::vector<JourneyStep> steps = MakeSteps(40);
  const RecordedFingerprint old = steps[0].fingerprints[0];
  ASSERT_NE(steps[39].fingerprints[0].fingerprint.landmark, old.fingerprint.landmark);
  AppendAll(*store_, kJourney, {steps.begin(), steps.begin() + 39});
  JourneyStep again;
  again.step = 39;
  again.fingerprints = {old};
  again.fingerprints[0].side = Side::kRight;
  ExpectRefused(again, "RIGHT must be LEFT");
  again.fingerprints[0].side = Side::kLeft;
  AppendAll(*store_, kJourney, {again});
}

TEST_P(AppendTest, ImportsAWholeJourneyFinished) {
  const JourneyMap map = MapOf(OddSettings(), WithProfiles(MakeSteps(50)));
  JourneyRecord record = Record("imported");
  record.next_sequence = 50;
  record.start_time_ns = 3;
  ASSERT_THAT(store_->ImportJourney(record, map), IsOk());
  const auto loaded = store_->LoadMap("imported");
  ASSERT_THAT(loaded, IsOk());
  EXPECT_TRUE(SameMap(*loaded, map));
  EXPECT_EQ(store_->GetJourney("imported")->state, JourneyState::kFinished);
  EXPECT_EQ(store_->GetJourney("imported")->start_time_ns, 3);
  EXPECT_THAT(store_->ImportJourney(record, map),
              StatusIs(absl::StatusCode::kAlreadyExists, HasSubstr("imported")));
}

TEST_P(AppendTest, DeletingAJourneyLeavesNothingOfItAndAllOfTheOthers) {
  ASSERT_THAT(store_->CreateJourney(Record(kOther)), IsOk());
  const std::vector<JourneyStep> steps = MakeSteps(20);
  AppendAll(*store_, kJourney, steps);
  AppendAll(*store_, kOther, steps);
  ASSERT_THAT(store_->DeleteJourney(kJourney), IsOk());
  EXPECT_TRUE(SameMap(*store_->LoadMap(kOther), MapOf(OddSettings(), steps)));
  // The row number is free again: the new journey must not find the old one's data.
  ASSERT_THAT(store_->CreateJourney(Record(kJourney)), IsOk());
  EXPECT_EQ(store_->LoadMap(kJourney)->step_count(), 0);
  AppendAll(*store_, kJourney, steps);
  EXPECT_TRUE(SameMap(*store_->LoadMap(kJourney), MapOf(OddSettings(), steps)));
}

TEST_P(AppendTest, ReadersBesideTheWriterSeeWholeSteps) {
  const std::vector<JourneyStep> steps = MakeSteps(150);
  std::atomic<bool> stop = false;
  std::atomic<int> bad = 0;
  std::vector<std::thread> readers;
  for (int i = 0; i < 6; ++i) {
    readers.emplace_back([&] {
      std::int64_t last = 0;
      while (!stop) {
        const auto map = store_->LoadMap(kJourney);
        const bool good =
            map.ok() && map->step_count() >= last && store_->ListJourneys("", "", 10).ok();
        if (!good) ++bad;
        if (map.ok()) last = map->step_count();
      }
    });
  }
  AppendAll(*store_, kJourney, steps);
  stop = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(bad, 0);
  EXPECT_TRUE(SameMap(*store_->LoadMap(kJourney), MapOf(OddSettings(), steps)));
}

INSTANTIATE_TEST_SUITE_P(Stores, AppendTest, EveryKind(), KindName);

}  // namespace
}  // namespace homing::storage
