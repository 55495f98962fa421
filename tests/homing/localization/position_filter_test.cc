#include "homing/localization/position_filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/landmark_world.h"

namespace homing {
namespace {

constexpr int kSteps = 250;
// Observations before the filter must know.
constexpr int kLearning = 40;

// One robot on its way through a world, with the map of one journey.
class Walk {
 public:
  explicit Walk(const JourneyMap& map, const PositionOptions& options = {})
      : map_(map), filter_(options) {}

  Position See(const SeenSides& seen, Motion motion = Motion::kMoving) {
    const JourneyRef ref{&name_, &map_};
    return filter_.Update({&ref, 1}, motion, seen);
  }

 private:
  std::string name_ = "robots/a/journeys/b";
  const JourneyMap& map_;
  PositionFilter filter_;
};

struct Score {
  int answers = 0;
  int right = 0;
  int direction_right = 0;
  int sure = 0;
  int sure_and_right = 0;
  int unknown = 0;
};

// From `start` at `speed` steps an observation (negative: homeward) to the end of the journey.
Score Travel(LandmarkWorld& world, Walk& walk, double start, double speed, int learning) {
  Score score;
  int taken = 0;
  for (double at = start; at >= 0 && at <= world.steps() - 1; at += speed) {
    const Position position = walk.See(world.See(at));
    if (++taken <= learning) {
      continue;
    }
    ++score.answers;
    const bool right = position.step && std::abs(static_cast<double>(*position.step) - at) <= 10;
    score.right += right ? 1 : 0;
    score.sure += position.outcome == Outcome::kMatch ? 1 : 0;
    score.sure_and_right += right && position.outcome == Outcome::kMatch ? 1 : 0;
    score.unknown += position.outcome == Outcome::kUnknownPlace ? 1 : 0;
    const Direction expected = speed < 0 ? Direction::kHomeward : Direction::kOutward;
    score.direction_right += position.direction == expected ? 1 : 0;
  }
  return score;
}

class PositionFilterDriveTest : public ::testing::TestWithParam<double> {};

TEST_P(PositionFilterDriveTest, FollowsBothWaysAtAnySpeed) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    for (const double sign : {-1.0, 1.0}) {
      SCOPED_TRACE(::testing::Message() << "seed " << seed << " sign " << sign);
      LandmarkWorld world(seed, kSteps);
      const JourneyMap map = world.Record();
      Walk walk(map);
      const double start = sign < 0 ? kSteps - 1 : 0;
      const Score score = Travel(world, walk, start, sign * GetParam(), kLearning);
      ASSERT_GT(score.answers, 50);
      EXPECT_GE(score.right, 0.95 * score.answers);
      EXPECT_GE(score.direction_right, 0.95 * score.answers);
      EXPECT_GE(score.sure, 0.5 * score.answers);
      EXPECT_GE(score.sure_and_right, 0.9 * score.sure);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Speeds, PositionFilterDriveTest,
                         ::testing::Values(0.5, 0.8, 1.0, 1.25, 2.0));

TEST(PositionFilterTest, KnowsNothingBeforeTheFirstMovingObservation) {
  LandmarkWorld world(1, kSteps);
  const JourneyMap map = world.Record();
  Walk walk(map);
  const Position position = walk.See({}, Motion::kStanding);
  EXPECT_EQ(position.outcome, Outcome::kAmbiguous);
  EXPECT_EQ(position.step, std::nullopt);
  EXPECT_EQ(position.direction, Direction::kUnknown);
  EXPECT_TRUE(walk.See(world.See(100)).step.has_value());
}

TEST(PositionFilterTest, StandingMovesNothing) {
  LandmarkWorld world(2, kSteps);
  const JourneyMap map = world.Record();
  Walk walk(map);
  Travel(world, walk, 100, 1, 0);
  const Position before = walk.See(world.See(kSteps - 1));
  for (int i = 0; i < 50; ++i) {
    const Position after = walk.See({}, Motion::kStanding);
    EXPECT_EQ(after.step, before.step);
    EXPECT_EQ(after.probability, before.probability);
    EXPECT_EQ(after.unknown_probability, before.unknown_probability);
  }
}

TEST(PositionFilterTest, TurningHardlyMoves) {
  LandmarkWorld world(2, kSteps);
  const JourneyMap map = world.Record();
  Walk walk(map);
  Position before;
  for (int at = 0; at < 120; ++at) {
    before = walk.See(world.See(at));
  }
  Position after;
  for (int i = 0; i < 5; ++i) {
    after = walk.See({}, Motion::kTurning);
  }
  EXPECT_NEAR(static_cast<double>(*after.step), static_cast<double>(*before.step), 1);
  EXPECT_NEAR(after.probability, before.probability, 0.01);
}

TEST(PositionFilterTest, GoesOnWhileNothingIsSeen) {
  LandmarkWorld world(3, kSteps);
  const JourneyMap map = world.Record();
  Walk walk(map);
  Position before;
  for (int at = 0; at < 120; ++at) {
    before = walk.See(world.See(at));
  }
  Position after;
  for (int i = 0; i < 20; ++i) {
    after = walk.See({});
  }
  EXPECT_NEAR(static_cast<double>(*after.step - *before.step), 20, 6);
  EXPECT_LT(after.probability, before.probability);
}

TEST(PositionFilterTest, FindsItselfAgainAfterBeingCarriedOff) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    LandmarkWorld world(seed, kSteps);
    const JourneyMap map = world.Record();
    Walk walk(map);
    for (int at = 200; at > 150; --at) {
      walk.See(world.See(at));
    }
    const Score score = Travel(world, walk, 20, 1, 80);
    EXPECT_GE(score.right, 0.9 * score.answers) << seed;
  }
}

TEST(PositionFilterTest, OtherLandmarksPlaceItWhenSomeHaveGone) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    LandmarkWorld world(seed, kSteps);
    const JourneyMap map = world.Record();
    world.Remove(0.3);
    Walk walk(map);
    const Score score = Travel(world, walk, kSteps - 1, -1, kLearning);
    EXPECT_GE(score.right, 0.9 * score.answers) << seed;
  }
}

TEST(PositionFilterTest, ForeignRouteIsAnUnknownPlace) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    LandmarkWorld world(seed, kSteps);
    const JourneyMap map = world.Record();
    LandmarkWorld foreign(seed + 100, kSteps);
    Walk walk(map);
    const Score score = Travel(foreign, walk, kSteps - 1, -1, kLearning);
    EXPECT_GE(score.unknown, 0.75 * score.answers) << seed;
    EXPECT_LE(score.sure, 0.1 * score.answers) << seed;
  }
}

TEST(PositionFilterTest, TellsTheJourneyItIsOn) {
  LandmarkWorld first(1, kSteps);
  LandmarkWorld second(2, kSteps);
  const JourneyMap first_map = first.Record();
  const JourneyMap second_map = second.Record();
  const std::string name = "n";
  const std::vector<JourneyRef> journeys{{&name, &first_map}, {&name, &second_map}};
  PositionFilter filter({});
  Position position;
  for (int at = 0; at < 80; ++at) {
    position = filter.Update(journeys, Motion::kMoving, second.See(at));
  }
  EXPECT_EQ(position.journey, 1);
  ASSERT_TRUE(position.step);
  EXPECT_NEAR(static_cast<double>(*position.step), 79, 5);
}

TEST(PositionFilterTest, FollowsOnAMapThatGrows) {
  LandmarkWorld world(4, kSteps);
  JourneyMap map = world.Record(60);
  Walk walk(map);
  for (int at = 20; at < 70; ++at) {
    walk.See(world.See(at % 50 + 5));
    world.Append(map);
  }
  // Set down on the part that is new.
  const Score score = Travel(world, walk, 65, 0.5, 50);
  EXPECT_GT(score.answers, 50);
  Position position;
  for (int at = 60; at < 110; ++at) {
    position = walk.See(world.See(at));
  }
  ASSERT_TRUE(position.step);
  EXPECT_NEAR(static_cast<double>(*position.step), 109, 5);
}

TEST(PositionFilterTest, WaitsForAJourneyWithoutSteps) {
  LandmarkWorld world(4, kSteps);
  JourneyMap map;
  Walk walk(map);
  const Position nowhere = walk.See(world.See(5));
  EXPECT_EQ(nowhere.step, std::nullopt);
  EXPECT_EQ(nowhere.outcome, Outcome::kAmbiguous);
  for (int i = 0; i < 60; ++i) {
    world.Append(map);
  }
  EXPECT_TRUE(walk.See(world.See(5)).step.has_value());
}

TEST(PositionFilterTest, OutcomeFollowsTheThresholds) {
  LandmarkWorld world(1, kSteps);
  const JourneyMap map = world.Record();
  PositionOptions easy;
  easy.match_probability = 1e-6;
  EXPECT_EQ(Walk(map, easy).See(world.See(100)).outcome, Outcome::kMatch);
  PositionOptions hard;
  hard.match_probability = 1;
  EXPECT_EQ(Walk(map, hard).See(world.See(100)).outcome, Outcome::kAmbiguous);
  PositionOptions lost;
  lost.unknown_probability = 1e-6;
  const Position position = Walk(map, lost).See(world.See(100));
  EXPECT_EQ(position.outcome, Outcome::kUnknownPlace);
  EXPECT_EQ(position.step, std::nullopt);
}

TEST(PositionFilterTest, IntervalIsTheStepAndTheToleranceWithinTheJourney) {
  LandmarkWorld world(1, kSteps);
  const JourneyMap map = world.Record();
  PositionOptions options;
  options.tolerance_steps = 7;
  Walk walk(map, options);
  for (int at = kSteps - 1; at >= 0; --at) {
    const Position position = walk.See(world.See(at));
    ASSERT_TRUE(position.step);
    EXPECT_EQ(position.interval_first, std::max<std::int64_t>(0, *position.step - 7));
    EXPECT_EQ(position.interval_last, std::min<std::int64_t>(kSteps - 1, *position.step + 7));
    EXPECT_DOUBLE_EQ(position.progress_home,
                     1 - static_cast<double>(*position.step) / (kSteps - 1));
    EXPECT_GT(position.probability, 0);
    EXPECT_LE(position.probability + position.unknown_probability, 1 + 1e-5);
  }
}

TEST(PositionFilterTest, SameObservationsGiveTheSameAnswers) {
  LandmarkWorld world(1, kSteps);
  const JourneyMap map = world.Record();
  Walk first(map);
  Walk second(map);
  for (int at = 0; at < 100; ++at) {
    const SeenSides seen = world.See(at);
    const Position a = first.See(seen);
    const Position b = second.See(seen);
    EXPECT_EQ(a.step, b.step);
    EXPECT_EQ(a.probability, b.probability);
    EXPECT_EQ(a.unknown_probability, b.unknown_probability);
  }
}

TEST(PositionFilterTest, SurvivesWithoutRestartWhatNothingExplains) {
  LandmarkWorld world(1, kSteps);
  const JourneyMap map = world.Record();
  PositionOptions options;
  options.restart_probability = 0;
  options.off_route_prior = 0;
  options.likelihood.outlier_share = 0;
  options.likelihood.temper = 1;
  Walk walk(map, options);
  LandmarkWorld foreign(77, kSteps);
  for (int at = 0; at < kSteps; ++at) {
    const Position position = walk.See(foreign.See(at));
    EXPECT_TRUE(std::isfinite(position.probability));
    EXPECT_TRUE(std::isfinite(position.unknown_probability));
  }
}

}  // namespace
}  // namespace homing
