#include "homing/journey/journey_recorder.h"

#include <limits>

#include "tests/support/journey_tail.h"
#include "tests/support/status_matchers.h"
#include "tests/support/travelling_robot.h"

namespace homing {
namespace {

using ::testing::HasSubstr;

// The map as it is stored: what a recorder knows after a restart.
void RecordInto(JourneyRecorder& recorder, const Observation& observation, JourneyMap& map) {
  const auto step = recorder.Record(observation);
  ASSERT_THAT(step, IsOk());
  if (*step) {
    ASSERT_THAT(map.Append(**step), IsOk());
  }
  map.mutable_settings() = recorder.settings();
}

JourneyMap RecordAll(const std::vector<Observation>& observations) {
  JourneyMap map;
  JourneyRecorder recorder(map.settings());
  for (const Observation& observation : observations) {
    RecordInto(recorder, observation, map);
  }
  return map;
}

// Stopped after `cut` observations; another recorder continues from the map and the reference.
JourneyMap RecordWithRestart(const std::vector<Observation>& observations, std::size_t cut) {
  JourneyMap map;
  JourneyRecorder recorder(map.settings());
  for (std::size_t i = 0; i < cut; ++i) RecordInto(recorder, observations[i], map);
  const auto resend_from = static_cast<std::size_t>(recorder.resend_from());
  recorder = JourneyRecorder(map.settings());
  recorder.Resume(test::TailOf(map));
  if (resend_from < cut) RecordInto(recorder, observations[resend_from], map);
  for (std::size_t i = cut; i < observations.size(); ++i) {
    RecordInto(recorder, observations[i], map);
  }
  return map;
}

void ExpectSame(const JourneyMap& a, const JourneyMap& b) {
  ASSERT_EQ(a.step_count(), b.step_count());
  EXPECT_EQ(a.landmarks(), b.landmarks());
  EXPECT_EQ(a.settings(), b.settings());
  for (std::int64_t step = 0; step < a.step_count(); ++step) {
    const auto in_a = a.fingerprints(step);
    const auto in_b = b.fingerprints(step);
    EXPECT_TRUE(std::equal(in_a.begin(), in_a.end(), in_b.begin(), in_b.end())) << step;
    EXPECT_EQ(a.sequence(step), b.sequence(step));
  }
}

TEST(InputKindTest, IsThatOfTheViews) {
  Observation observation;
  EXPECT_THAT(InputKindOf(observation), StatusIs(absl::StatusCode::kInvalidArgument,
                                                 HasSubstr("left: must be set unless right is")));
  observation.views[1] = FlowField{};
  EXPECT_EQ(InputKindOf(observation).value(), InputKind::kFlowVectors);
  observation.views[0] = Frame{};
  EXPECT_THAT(InputKindOf(observation),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("right: must be frames or flow vectors, as left is")));
  observation.views[1] = std::monostate{};
  EXPECT_EQ(InputKindOf(observation).value(), InputKind::kFrames);
}

TEST(JourneyRecorderTest, StepsAreNumberedOnAndKeepTheFrameThatMadeThem) {
  const auto frames = TravellingRobot::WithFrames(6, 3);
  JourneyRecorder recorder{JourneySettings{}};
  std::int64_t steps = 0;
  for (std::int64_t i = 0; i < 18; ++i) {
    // Each frame comes three times.
    Observation observation = frames.observations()[static_cast<std::size_t>(i / 3)];
    observation.sequence = i;
    const auto step = recorder.Record(observation).value();
    ASSERT_EQ(step.has_value(), i >= 3 && i % 3 == 0) << i;
    EXPECT_EQ(recorder.resend_from(), i - i % 3);
    if (!step) continue;
    EXPECT_EQ(step->step, steps++);
    EXPECT_EQ(step->sequence, i);
  }
  EXPECT_EQ(steps, 5);
}

TEST(JourneyRecorderTest, AStepOfFlowVectorsKeepsTheFrameThatTheClientNames) {
  auto robot = TravellingRobot::WithFlowVectors(3, 3);
  robot.mutable_observations()[0].frame = 4;
  robot.mutable_observations()[1].frame = 9;
  robot.mutable_observations()[2].frame = 9;
  JourneyRecorder recorder{JourneySettings{}};
  EXPECT_EQ(recorder.Record(robot.observations()[0]).value()->sequence, 4);
  EXPECT_EQ(recorder.Record(robot.observations()[1]).value()->sequence, 9);
  EXPECT_EQ(recorder.resend_from(), 2);
  EXPECT_THAT(recorder.Record(robot.observations()[2]),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("frame: 9 must be over")));
}

TEST(JourneyRecorderTest, RecordsLandmarksOfBothSides) {
  for (const auto& robot :
       {TravellingRobot::WithFrames(30, 1), TravellingRobot::WithFlowVectors(30, 1)}) {
    const JourneyMap map = RecordAll(robot.observations());
    std::array<int, 2> on_side{};
    for (const Landmark& landmark : map.landmarks()) {
      ++on_side[static_cast<std::size_t>(landmark.side)];
    }
    EXPECT_GE(on_side[0], 2);
    EXPECT_GE(on_side[1], 2);
    EXPECT_GE(map.all_fingerprints().size(), 50u);
  }
}

TEST(JourneyRecorderTest, ResumedRecordingOfFlowVectorsIsTheUndisturbedOne) {
  const auto robot = TravellingRobot::WithFlowVectors(60, 3);
  const JourneyMap whole = RecordAll(robot.observations());
  for (std::size_t cut = 0; cut <= robot.observations().size(); ++cut) {
    SCOPED_TRACE(cut);
    ExpectSame(RecordWithRestart(robot.observations(), cut), whole);
  }
}

TEST(JourneyRecorderTest, ResumedRecordingOfFramesIsTheUndisturbedOne) {
  const auto robot = TravellingRobot::WithFrames(14, 3);
  const JourneyMap whole = RecordAll(robot.observations());
  for (std::size_t cut = 0; cut <= robot.observations().size(); ++cut) {
    SCOPED_TRACE(cut);
    ExpectSame(RecordWithRestart(robot.observations(), cut), whole);
  }
}

// A robot so slow that the reference is many frames back.
TEST(JourneyRecorderTest, ResumedRecordingOfASlowRobotIsTheUndisturbedOne) {
  const auto frames = TravellingRobot::WithFrames(4, 3);
  std::vector<Observation> slow;
  for (std::size_t i = 0; i < 28; ++i) {
    slow.push_back(frames.observations()[i / 7]);
    slow.back().sequence = static_cast<std::int64_t>(i);
  }
  const JourneyMap whole = RecordAll(slow);
  ASSERT_EQ(whole.step_count(), 3);
  for (std::size_t cut = 0; cut <= slow.size(); ++cut) {
    SCOPED_TRACE(cut);
    ExpectSame(RecordWithRestart(slow, cut), whole);
  }
}

TEST(JourneyRecorderTest, RepeatsBelowTheMapMakeNoStep) {
  const auto robot = TravellingRobot::WithFrames(10, 3);
  JourneyMap map = RecordAll({robot.observations().begin(), robot.observations().begin() + 8});
  JourneyRecorder recorder(map.settings());
  recorder.Resume(test::TailOf(map));
  for (std::size_t i = 3; i < 10; ++i) RecordInto(recorder, robot.observations()[i], map);
  ExpectSame(map, RecordAll(robot.observations()));
}

TEST(JourneyRecorderTest, OrdersFingerprintsBySideAndPosition) {
  const JourneyMap map = RecordAll(TravellingRobot::WithFlowVectors(40, 5).observations());
  int pairs = 0;
  for (std::int64_t step = 0; step < map.step_count(); ++step) {
    const auto fingerprints = map.fingerprints(step);
    for (std::size_t i = 1; i < fingerprints.size(); ++i) {
      const Side before = map.side_of(fingerprints[i - 1]);
      const Side side = map.side_of(fingerprints[i]);
      EXPECT_LE(before, side);
      if (before == side) {
        EXPECT_LT(fingerprints[i - 1].x, fingerprints[i].x);
        ++pairs;
      }
    }
  }
  EXPECT_GT(pairs, 10);
}

TEST(JourneyRecorderTest, NoStepSpansABreak) {
  for (auto robot : {TravellingRobot::WithFrames(8, 2), TravellingRobot::WithFlowVectors(8, 2)}) {
    robot.mutable_observations()[5].break_before = true;
    const JourneyMap map = RecordAll(robot.observations());
    const std::int64_t broken =
        InputKindOf(robot.observations()[0]).value() == InputKind::kFrames ? 4 : 5;
    EXPECT_EQ(map.sequence(broken - 1), 4);
    EXPECT_EQ(map.sequence(broken), 6);
    EXPECT_FALSE(map.fingerprints(broken).empty());
    EXPECT_EQ(map.step_count(), broken + 2);
  }
}

TEST(JourneyRecorderTest, StandingMakesNoStepAndTurningNoFingerprint) {
  auto robot = TravellingRobot::WithFlowVectors(3, 2);
  for (CameraView& view : robot.mutable_observations()[1].views) {
    for (FlowVector& vector : std::get<FlowField>(view).vectors) {
      vector.end_x = vector.start_x;
    }
  }
  // Both cameras' images move the same way: the robot turns.
  robot.mutable_observations()[2].views[1] = robot.observations()[2].views[0];
  JourneyRecorder recorder{JourneySettings{}};
  EXPECT_EQ(recorder.Record(robot.observations()[0]).value()->motion, Motion::kMoving);
  EXPECT_EQ(recorder.Record(robot.observations()[1]).value(), std::nullopt);
  const JourneyStep turning = recorder.Record(robot.observations()[2]).value().value();
  EXPECT_EQ(turning.motion, Motion::kTurning);
  EXPECT_TRUE(turning.fingerprints.empty());
}

TEST(JourneyRecorderTest, LearnsImageSizesFromTheFirstObservation) {
  const auto robot = TravellingRobot::WithFrames(1, 2);
  JourneyRecorder recorder{JourneySettings{}};
  ASSERT_THAT(recorder.Record(robot.observations()[0]), IsOk());
  EXPECT_EQ(recorder.settings().cameras[0].width, TravellingRobot::kWidth);
  EXPECT_EQ(recorder.settings().cameras[1].height, TravellingRobot::kHeight);
}

TEST(JourneyRecorderTest, RefusesImagesUnlikeTheJourneysCamera) {
  JourneySettings settings;
  settings.cameras[1].width = 320;
  settings.cameras[1].height = 240;
  for (const auto& robot :
       {TravellingRobot::WithFrames(2, 2), TravellingRobot::WithFlowVectors(2, 2)}) {
    JourneyRecorder recorder(settings);
    EXPECT_THAT(recorder.Record(robot.observations()[0]),
                StatusIs(absl::StatusCode::kFailedPrecondition,
                         ::testing::AllOf(HasSubstr("right"), HasSubstr("320"), HasSubstr("160"))));
    EXPECT_EQ(recorder.settings(), settings);
  }
}

TEST(JourneyRecorderTest, ErrorLeavesNoTrace) {
  const auto robot = TravellingRobot::WithFrames(6, 4);
  const JourneyMap whole = RecordAll(robot.observations());
  JourneyMap map;
  JourneyRecorder recorder(map.settings());
  for (const Observation& observation : robot.observations()) {
    Observation wrong = observation;
    std::get<Frame>(wrong.views[1]).width = 64;
    EXPECT_THAT(recorder.Record(wrong),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("right")));
    RecordInto(recorder, observation, map);
  }
  ExpectSame(map, whole);
}

TEST(JourneyRecorderTest, RefusesAnotherKindThanTheFirst) {
  JourneyRecorder recorder{JourneySettings{}};
  const auto frames = TravellingRobot::WithFrames(1, 2);
  ASSERT_THAT(recorder.Record(frames.observations()[0]), IsOk());
  Observation vectors = TravellingRobot::WithFlowVectors(2, 2).observations()[1];
  EXPECT_THAT(recorder.Record(vectors),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("flow vectors must be frames, as before")));
}

}  // namespace
}  // namespace homing
