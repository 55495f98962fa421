#include "homing/journey/journey_map.h"

#include <limits>

#include "tests/support/status_matchers.h"

namespace homing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

RecordedFingerprint Seen(Side side, std::int32_t landmark, double spread = 0) {
  return {side, {.x = 10, .y = 20, .count = 30, .landmark = landmark}, spread};
}

JourneyStep StepOf(std::int64_t number, std::vector<RecordedFingerprint> fingerprints) {
  return {.step = number,
          .motion = Motion::kMoving,
          .fingerprints = std::move(fingerprints),
          .profiles = {}};
}

absl::Status Refusal(const JourneyStep& step) {
  JourneyMap map;
  EXPECT_THAT(map.Append(StepOf(0, {Seen(Side::kLeft, 0)})), IsOk());
  const absl::Status status = map.Append(step);
  EXPECT_EQ(map.step_count(), 1);
  EXPECT_EQ(map.all_fingerprints().size(), 1u);
  EXPECT_EQ(map.landmarks().size(), 1u);
  return status;
}

TEST(JourneyMapTest, KeepsFingerprintsByStep) {
  JourneyMap map;
  ASSERT_THAT(map.Append(StepOf(0, {Seen(Side::kLeft, 0), Seen(Side::kRight, 1)})), IsOk());
  ASSERT_THAT(map.Append(StepOf(3, {Seen(Side::kRight, 1)})), IsOk());
  ASSERT_EQ(map.step_count(), 4);
  EXPECT_EQ(map.fingerprints(0).size(), 2u);
  EXPECT_TRUE(map.fingerprints(1).empty());
  EXPECT_TRUE(map.fingerprints(2).empty());
  ASSERT_EQ(map.fingerprints(3).size(), 1u);
  EXPECT_EQ(map.fingerprints(3)[0].landmark, 1);
  EXPECT_EQ(map.side_of(map.fingerprints(3)[0]), Side::kRight);
}

TEST(JourneyMapTest, CountsLandmarksInTheOrderMet) {
  JourneyMap map;
  ASSERT_THAT(map.Append(StepOf(2, {Seen(Side::kLeft, 0, 0.5)})), IsOk());
  ASSERT_THAT(map.Append(StepOf(3, {Seen(Side::kLeft, 0, 0.25), Seen(Side::kRight, 1, 1)})),
              IsOk());
  ASSERT_THAT(map.Append(StepOf(5, {Seen(Side::kLeft, 0, 0.75)})), IsOk());
  EXPECT_THAT(map.landmarks(),
              ElementsAre(Landmark{Side::kLeft, 2, 5, 3, 0.5}, Landmark{Side::kRight, 3, 3, 1, 1}));
}

TEST(JourneyMapTest, ExtendsWithEmptySteps) {
  JourneyMap map;
  ASSERT_THAT(map.Append(StepOf(0, {Seen(Side::kLeft, 0)})), IsOk());
  map.ExtendTo(3);
  map.ExtendTo(2);
  EXPECT_EQ(map.step_count(), 3);
  EXPECT_EQ(map.fingerprints(0).size(), 1u);
  EXPECT_TRUE(map.fingerprints(2).empty());
}

TEST(JourneyMapTest, RefusesAStepThatIsThere) {
  EXPECT_THAT(Refusal(StepOf(0, {})),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("step: 0 must be in [1, ")));
  EXPECT_THAT(Refusal(StepOf(kMostSteps, {})),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("step: 20000000")));
}

TEST(JourneyMapTest, StepsWithoutASequenceFollowTheOneBefore) {
  JourneyMap map;
  ASSERT_THAT(map.Append(StepOf(1, {})), IsOk());
  JourneyStep step = StepOf(4, {});
  step.sequence = 30;
  ASSERT_THAT(map.Append(step), IsOk());
  map.ExtendTo(6);
  const std::vector<std::int64_t> expected{1, 2, 28, 29, 30, 31};
  for (std::int64_t i = 0; i < 6; ++i) {
    EXPECT_EQ(map.sequence(i), expected[static_cast<std::size_t>(i)]) << i;
  }
}

TEST(JourneyMapTest, RefusesASequenceThatLeavesNoneForTheStepsBetween) {
  JourneyMap map;
  JourneyStep step = StepOf(2, {});
  step.sequence = 1;
  EXPECT_THAT(map.Append(step), StatusIs(absl::StatusCode::kInvalidArgument,
                                         HasSubstr("sequence of step 2: 1 must be at least 2")));
  EXPECT_EQ(map.step_count(), 0);
  step.sequence = 2;
  ASSERT_THAT(map.Append(step), IsOk());
  EXPECT_EQ(map.sequence(0), 0);
  step = StepOf(3, {});
  step.sequence = 2;
  EXPECT_THAT(map.Append(step), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("least 3")));
}

TEST(JourneyMapTest, RefusesALandmarkThatIsNeitherKnownNorNext) {
  EXPECT_THAT(Refusal(StepOf(1, {Seen(Side::kLeft, 2)})),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("landmark: 2 must be")));
  EXPECT_THAT(Refusal(StepOf(1, {Seen(Side::kLeft, -1)})),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("landmark: -1 must be")));
  EXPECT_THAT(Refusal(StepOf(1, {Seen(Side::kLeft, 1), Seen(Side::kLeft, 1)})),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("twice")));
}

TEST(JourneyMapTest, RefusesALandmarkOnTheOtherSide) {
  EXPECT_THAT(Refusal(StepOf(1, {Seen(Side::kRight, 0)})),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("side of landmark 0")));
}

TEST(JourneyMapTest, RefusesSidesOutOfOrderAndTooManyOnOne) {
  EXPECT_THAT(Refusal(StepOf(1, {Seen(Side::kRight, 1), Seen(Side::kLeft, 0)})),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("left before right")));
  EXPECT_THAT(
      Refusal(StepOf(1, {Seen(Side::kLeft, 0), Seen(Side::kLeft, 1), Seen(Side::kLeft, 2)})),
      StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("at most 2 on one side")));
}

TEST(JourneyMapTest, RefusesValuesThatAreNoFingerprint) {
  RecordedFingerprint seen = Seen(Side::kLeft, 0);
  seen.fingerprint.count = 0;
  EXPECT_THAT(Refusal(StepOf(1, {seen})), StatusIs(absl::StatusCode::kInvalidArgument,
                                                   HasSubstr("count of landmark 0: 0 must be")));
  seen = Seen(Side::kLeft, 0);
  seen.fingerprint.y = std::numeric_limits<float>::infinity();
  EXPECT_THAT(Refusal(StepOf(1, {seen})),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("finite")));
  seen = Seen(Side::kLeft, 0, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(Refusal(StepOf(1, {seen})),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("spread")));
}

TEST(JourneyMapTest, SpreadIsTakenUpAsStored) {
  JourneyMap whole;
  JourneyMap resumed;
  const std::vector<double> spreads{0.1, 0.7, 0.3, 0.9};
  for (std::size_t i = 0; i < spreads.size(); ++i) {
    const auto number = static_cast<std::int64_t>(i);
    ASSERT_THAT(whole.Append(StepOf(number, {Seen(Side::kLeft, 0, spreads[i])})), IsOk());
    // As loaded: the fingerprints, and the mean.
    ASSERT_THAT(resumed.Append(StepOf(number, {Seen(Side::kLeft, 0, i < 2 ? 0 : spreads[i])})),
                IsOk());
    if (i == 1) {
      resumed.set_spread(0, whole.landmarks()[0].spread);
    }
  }
  EXPECT_EQ(whole.landmarks(), resumed.landmarks());
}

}  // namespace
}  // namespace homing
