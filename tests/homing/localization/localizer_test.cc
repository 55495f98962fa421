#include "homing/localization/localizer.h"

#include "homing/journey/journey_recorder.h"
#include "tests/support/route.h"
#include "tests/support/status_matchers.h"
#include "tests/support/travelling_robot.h"

namespace homing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

JourneyMap RecordAll(const TravellingRobot& robot) {
  JourneyRecorder recorder{JourneySettings{}};
  JourneyMap map;
  for (const Observation& observation : robot.observations()) {
    const auto step = recorder.Record(observation);
    EXPECT_THAT(step, IsOk());
    if (*step) {
      EXPECT_THAT(map.Append(**step), IsOk());
    }
  }
  map.mutable_settings() = recorder.settings();
  return map;
}

LocalizerOptions Same() {
  LocalizerOptions options;
  options.travel = Travel::kSame;
  return options;
}

class LocalizerTest : public ::testing::Test {
 protected:
  std::string name_ = "robots/a/journeys/b";
  TravellingRobot robot_ = TravellingRobot::WithFrames(30, 3);
  JourneyMap map_ = RecordAll(robot_);
  JourneyRef journey_{&name_, &map_};
};

TEST_F(LocalizerTest, SameFramesMatchTheirOwnSteps) {
  Localizer localizer(Same());
  int right = 0;
  for (const Observation& observation : robot_.observations()) {
    const auto answer = localizer.Localize(observation, {&journey_, 1});
    ASSERT_THAT(answer, IsOk());
    EXPECT_EQ(answer->sequence, observation.sequence);
    EXPECT_EQ(answer->has_flow, observation.sequence > 0);
    if (answer->has_flow && !map_.fingerprints(observation.sequence - 1).empty()) {
      ASSERT_FALSE(answer->matches.empty());
      EXPECT_EQ(answer->matches[0].similarity.p_t, 1);
      right += answer->matches[0].step == observation.sequence - 1 ? 1 : 0;
      EXPECT_TRUE(answer->position.step.has_value());
    }
  }
  EXPECT_GE(right, 25);
}

TEST_F(LocalizerTest, FirstFrameTellsNothing) {
  Localizer localizer(Same());
  const auto answer = localizer.Localize(robot_.observations()[0], {&journey_, 1});
  ASSERT_THAT(answer, IsOk());
  EXPECT_FALSE(answer->has_flow);
  EXPECT_TRUE(answer->matches.empty());
  EXPECT_FALSE(answer->position.step.has_value());
  EXPECT_FALSE(answer->landmark.has_value());
}

// Every frame three times: the answers to the first of each are those without repeats.
TEST_F(LocalizerTest, AnObservationWithoutAStepLeavesTheBeliefAsItIs) {
  Localizer once(Same());
  Localizer thrice(Same());
  for (const Observation& observation : robot_.observations()) {
    const auto expected = once.Localize(observation, {&journey_, 1}).value();
    for (int copy = 0; copy < 3; ++copy) {
      Observation repeated = observation;
      repeated.sequence = 3 * observation.sequence + copy;
      const auto answer = thrice.Localize(repeated, {&journey_, 1}).value();
      EXPECT_EQ(answer.sequence, repeated.sequence);
      EXPECT_EQ(answer.position.step, expected.position.step);
      EXPECT_EQ(answer.position.probability, expected.position.probability);
      EXPECT_EQ(answer.landmark, expected.landmark);
      if (copy == 0) {
        EXPECT_EQ(answer.motion, expected.motion);
        continue;
      }
      EXPECT_EQ(answer.motion, Motion::kStanding);
      EXPECT_TRUE(answer.has_flow);
      EXPECT_TRUE(answer.matches.empty());
    }
  }
}

TEST_F(LocalizerTest, LandmarkIsTheBestMatchOfTheInterval) {
  Localizer localizer(Same());
  int told = 0;
  for (const Observation& observation : robot_.observations()) {
    const auto answer = localizer.Localize(observation, {&journey_, 1});
    ASSERT_THAT(answer, IsOk());
    if (answer->landmark) {
      ++told;
      ASSERT_TRUE(answer->similarity);
      EXPECT_GE(*answer->similarity, kRecognitionThreshold);
      const Landmark& landmark = map_.landmarks()[static_cast<std::size_t>(*answer->landmark)];
      EXPECT_LE(landmark.first_step, answer->position.interval_last);
      EXPECT_GE(landmark.last_step, answer->position.interval_first);
    }
  }
  EXPECT_GE(told, 20);
}

TEST_F(LocalizerTest, ReturningRobotSeesTheOtherSide) {
  LocalizerOptions options;
  options.travel = Travel::kReturn;
  Localizer localizer(options);
  int right = 0;
  for (Observation observation : robot_.observations()) {
    std::swap(observation.views[0], observation.views[1]);
    const auto answer = localizer.Localize(observation, {&journey_, 1});
    ASSERT_THAT(answer, IsOk());
    right += !answer->matches.empty() && answer->matches[0].similarity.p_t == 1 ? 1 : 0;
  }
  EXPECT_GE(right, 25);
}

TEST_F(LocalizerTest, AfterABreakTheBeliefWaits) {
  Localizer localizer(Same());
  Position before;
  for (Observation observation : robot_.observations()) {
    observation.break_before = observation.sequence == 20;
    const auto answer = localizer.Localize(observation, {&journey_, 1});
    ASSERT_THAT(answer, IsOk());
    if (observation.break_before) {
      EXPECT_FALSE(answer->has_flow);
      EXPECT_EQ(answer->position.step, before.step);
      EXPECT_EQ(answer->position.probability, before.probability);
    }
    before = answer->position;
  }
}

TEST_F(LocalizerTest, RefusesACameraUnlikeTheOneThatRecorded) {
  map_.mutable_settings().cameras[1].width = 640;
  map_.mutable_settings().cameras[1].height = 480;
  Localizer localizer(Same());
  EXPECT_THAT(localizer.Localize(robot_.observations()[0], {&journey_, 1}),
              StatusIs(absl::StatusCode::kFailedPrecondition,
                       AllOf(HasSubstr("right"), HasSubstr("640"), HasSubstr("160"))));
  // Having changed sides, it is the left camera that sees the route's right side.
  Localizer returning(LocalizerOptions{});
  EXPECT_THAT(returning.Localize(robot_.observations()[0], {&journey_, 1}),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("left")));
}

TEST_F(LocalizerTest, ErrorLeavesNoTrace) {
  Localizer disturbed(Same());
  Localizer undisturbed(Same());
  for (const Observation& observation : robot_.observations()) {
    Observation wrong = observation;
    std::get<Frame>(wrong.views[1]).width = 64;
    EXPECT_THAT(disturbed.Localize(wrong, {&journey_, 1}),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("right")));
    const auto a = disturbed.Localize(observation, {&journey_, 1});
    const auto b = undisturbed.Localize(observation, {&journey_, 1});
    ASSERT_THAT(a, IsOk());
    ASSERT_THAT(b, IsOk());
    EXPECT_EQ(a->position.step, b->position.step);
    EXPECT_EQ(a->position.probability, b->position.probability);
    EXPECT_EQ(a->matches.size(), b->matches.size());
  }
}

constexpr double kFocal = 300;

// What both cameras see at `place` while the robot drives on and turns by `turn` rad to the left.
Observation SeenAt(std::int64_t sequence, int place, double turn) {
  Observation observation;
  observation.sequence = sequence;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    FlowField field{.width = 320, .height = 240, .vectors = {}};
    for (std::uint32_t i = 0; i < 120; ++i) {
      const double x = 15 + 24.0 * (i % 12), y = 15 + 20.0 * (i / 12);
      const double right = (x - 159.5) / kFocal, down = (y - 119.5) / kFocal;
      const double nearness = 0.6 + 0.8 * test::Noise(static_cast<std::uint32_t>(place), i,
                                                      side == Side::kLeft ? 1 : 2);
      const double moved_x =
          kFocal * turn * (1 + right * right) + (side == Side::kLeft ? -10 : 10) * nearness;
      const double moved_y = kFocal * turn * right * down;
      field.vectors.push_back(
          {static_cast<float>(x - moved_x / 2), static_cast<float>(y - moved_y / 2),
           static_cast<float>(x + moved_x / 2), static_cast<float>(y + moved_y / 2)});
    }
    observation.views[static_cast<std::size_t>(side)] = std::move(field);
  }
  return observation;
}

TEST(LocalizerTurnTest, TheTurnInWhichThePlaceIsLostCountsOnce) {
  constexpr double kTurned = 0.02;
  Camera camera;
  camera.width = 320;
  camera.height = 240;
  camera.intrinsics = Intrinsics{kFocal, kFocal, 159.5, 119.5};
  JourneySettings settings;
  settings.cameras = {camera, camera};
  JourneyRecorder recorder{settings};
  JourneyMap map;
  for (int place = 0; place < 60; ++place) {
    const auto step = recorder.Record(SeenAt(place, place, 0));
    ASSERT_THAT(step, IsOk());
    ASSERT_TRUE(step->has_value());
    ASSERT_THAT(map.Append(**step), IsOk());
  }
  map.mutable_settings() = recorder.settings();
  const std::string name = "robots/a/journeys/b";
  const JourneyRef journey{&name, &map};
  LocalizerOptions options = Same();
  options.cameras = settings.cameras;
  Localizer localizer(options);
  Localization answer;
  for (int place = 0; place < 30; ++place) {
    answer = localizer.Localize(SeenAt(place, place, 0), {&journey, 1}).value();
  }
  ASSERT_TRUE(answer.position.step);
  // Elsewhere, in a bend.
  for (int i = 30; i < 90 && answer.position.step; ++i) {
    answer = localizer.Localize(SeenAt(i, 1000 + i, kTurned), {&journey, 1}).value();
  }
  ASSERT_FALSE(answer.position.step);
  ASSERT_EQ(answer.motion, Motion::kMoving);
  ASSERT_TRUE(answer.turn);
  EXPECT_NEAR(*answer.turn, kTurned, 0.3 * kTurned);
}

TEST(CheckCompatibleTest, ComparesOptionsAndSizesBySideOfTheRoute) {
  LocalizerOptions query;
  JourneySettings settings;
  EXPECT_THAT(CheckCompatible(query, settings), IsOk());
  settings.cameras[0].width = 320;
  settings.cameras[0].height = 240;
  query.cameras[0].width = 640;
  query.cameras[0].height = 480;
  // The left camera sees the right side on the way home.
  EXPECT_THAT(CheckCompatible(query, settings), IsOk());
  query.travel = Travel::kSame;
  EXPECT_THAT(CheckCompatible(query, settings),
              StatusIs(absl::StatusCode::kFailedPrecondition,
                       AllOf(HasSubstr("left"), HasSubstr("640x480"), HasSubstr("320x240"))));
  query = {};
  query.flow.cell_px += 1;
  EXPECT_THAT(CheckCompatible(query, settings),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("flow")));
  query = {};
  query.landmark.min_vectors += 1;
  EXPECT_THAT(CheckCompatible(query, settings),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("landmark")));
}

TEST(LocalizerOptionsTest, NamesTheOptionThatIsOutOfRange) {
  EXPECT_THAT(Validate(LocalizerOptions{}), IsOk());
  LocalizerOptions options;
  options.match.max_matches = 0;
  EXPECT_THAT(Validate(options),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("match.max_matches: 0")));
  options = {};
  options.position.likelihood.temper = 0;
  EXPECT_THAT(Validate(options), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("temper")));
}

}  // namespace
}  // namespace homing
