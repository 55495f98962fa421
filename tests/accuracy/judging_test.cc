#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/accuracy/honesty.h"
#include "tests/accuracy/run_plan.h"
#include "tests/accuracy/scores.h"
#include "tests/support/temporary_folder.h"

namespace homing::accuracy {
namespace {

using ::testing::ElementsAre;
// Tests have a member of that name.
using OneRun = Run;

// A frame at place 10 times its number; it makes a step if so asked.
Instant InstantOf(std::int64_t frame, bool makes_step) {
  Instant instant;
  instant.frame = frame;
  instant.place = 10 * static_cast<double>(frame);
  if (makes_step) instant.flow.fields[0] = FlowField{.width = 8, .height = 8, .vectors = {}};
  return instant;
}

Drive DriveOf(const std::vector<bool>& steps) {
  Drive drive;
  for (const bool makes_step : steps) {
    drive.push_back(InstantOf(static_cast<std::int64_t>(drive.size()), makes_step));
  }
  return drive;
}

Run RunOf(const Drive& query) {
  OneRun run;
  for (const Instant& instant : query) run.query.push_back(&instant);
  return run;
}

Answer AnswerOf(double place, double probability = 0.5, Outcome outcome = Outcome::kAmbiguous,
                double on_route = 1) {
  return {.place = place, .score = probability, .outcome = outcome, .on_route = on_route};
}

TEST(RunTest, AtAFrameWithoutAStepTheLastAnswerStands) {
  const Drive query = DriveOf({false, false, true, false, true});
  const OneRun run = RunOf(query);
  ASSERT_EQ(run.QuerySteps().size(), 2U);
  const Answers answers = run.ByInstant({AnswerOf(7), AnswerOf(8)});
  std::vector<double> places;
  for (const Answer& answer : answers)
    places.push_back(std::isnan(answer.place) ? -1 : answer.place);
  EXPECT_THAT(places, ElementsAre(-1, -1, 7, 7, 8));
}

TEST(RunTest, AnAnswerWithoutAStepIsWrongAndTheFirstFrameIsNotJudged) {
  const Drive query = DriveOf({false, false, true});
  OneRun run = RunOf(query);
  run.homing = run.ByInstant({AnswerOf(20)});
  EXPECT_FALSE(run.Judged(0));
  const auto judged = Judge({&run}, &OneRun::homing);
  ASSERT_EQ(judged.size(), 2U);
  EXPECT_FALSE(judged[0].right);
  EXPECT_TRUE(judged[1].right);
}

TEST(RunTest, ATruthFromPicturesMayBeHalfAToleranceOff) {
  const Drive query = DriveOf({true});
  OneRun run = RunOf(query);
  run.tolerance = 2;
  EXPECT_FALSE(run.RightEnough(AnswerOf(2.5), 0));
  run.truth_from_pictures = true;
  EXPECT_FALSE(run.Right(AnswerOf(2.5), 0));
  EXPECT_TRUE(run.RightEnough(AnswerOf(2.5), 0));
  EXPECT_FALSE(run.RightEnough(AnswerOf(3.5), 0));
}

TEST(RunTest, BeyondEitherEndNothingIsRight) {
  const Drive query = DriveOf({true, true, true});
  OneRun run = RunOf(query);
  run.end = 15;
  EXPECT_TRUE(run.Right(AnswerOf(10), 1));
  EXPECT_EQ(run.Beyond(2), 5);
  EXPECT_FALSE(run.Judged(2));
  EXPECT_FALSE(run.Right(AnswerOf(20), 2));
  run.end = 0;
  EXPECT_EQ(run.Beyond(2), -20);
}

TEST(RunPlanTest, TheToleranceBecomesStepsOfTheMap) {
  RunPlan plan;
  // Six frames that make three steps: 20 apart.
  plan.AddDrive("map", [] { return DriveOf({false, true, false, true, false, true}); });
  plan.AddDrive("query", [] { return DriveOf({false, true}); });
  for (const double tolerance : {1.0, 30.0, 31.0, 45.0}) {
    OneRun run;
    run.set = "set";
    run.tolerance = tolerance;
    run.tolerance_steps = 0;
    plan.AddRun(run, "map", "query");
  }
  std::vector<int> steps;
  for (const OneRun& run : plan.Make(SetFilter(""))) steps.push_back(run.tolerance_steps);
  EXPECT_THAT(steps, ElementsAre(1, 1, 2, 2));
}

TEST(RunPlanTest, OnlyTheDrivesOfTheSetsAskedForAreMade) {
  RunPlan plan;
  int made = 0;
  for (const char* name : {"a", "b"}) {
    plan.AddDrive(name, [&made] {
      ++made;
      return DriveOf({false, true, true});
    });
  }
  OneRun run;
  run.set = "office:2";
  run.real = true;
  plan.AddRun(run, "a", "a");
  run.set = "street same";
  run.real = false;
  plan.AddRun(run, "b", "b");
  EXPECT_EQ(plan.Make(SetFilter("real")).size(), 1U);
  EXPECT_EQ(plan.Make(SetFilter("office")).size(), 1U);
  EXPECT_EQ(plan.Make(SetFilter("off")).size(), 0U);
  EXPECT_EQ(made, 2);
  EXPECT_EQ(plan.Make(SetFilter("street,office:2")).size(), 2U);
  EXPECT_EQ(plan.Make(SetFilter("simulated"))[0].set, "street same");
}

TEST(ScoresTest, LateAnswersAreTheFiftiethAndLaterOrTheSecondHalf) {
  OneRun run;
  run.homing.resize(20);
  for (std::size_t i = 10; i < 20; ++i) run.homing[i].outcome = Outcome::kUnknownPlace;
  EXPECT_EQ(LateShare({&run}, Outcome::kUnknownPlace), 1);
  run.homing.resize(99);
  EXPECT_EQ(LateShare({&run}, Outcome::kUnknownPlace), 0);
}

TEST(ScoresTest, TimeToMatchCountsFromTheFirstStepToTheFirstRightMatch) {
  const Drive query = DriveOf({false, true, true, true});
  OneRun run = RunOf(query);
  run.homing = run.ByInstant(
      {AnswerOf(50, 1, Outcome::kMatch), AnswerOf(20), AnswerOf(30, 1, Outcome::kMatch)});
  EXPECT_EQ(TimeToMatch(run), 3);
}

// Answers of many probabilities; `shift` more of them are right than they say.
std::vector<Judgement> Forecast(double shift) {
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Judgement> judgements;
  for (int i = 0; i < 400; ++i) {
    const double probability = uniform(engine);
    judgements.push_back({uniform(engine) < probability + shift, probability});
  }
  return judgements;
}

TEST(HonestyTest, APerfectForecasterIsNoWorseThanAPerfectOne) {
  const double perfect = PerfectCalibrationError(Forecast(0));
  EXPECT_GT(perfect, 0.01);
  EXPECT_LT(std::abs(CalibrationOf(Forecast(0)).expected_error - perfect), 0.03);
  EXPECT_GT(CalibrationOf(Forecast(-0.3)).expected_error - perfect, 0.08);
}

TEST(HonestyTest, OutcomeProbabilityAndOnRouteMustAgree) {
  const auto disagrees = [](const Answer& answer) {
    OneRun run;
    run.homing = {answer};
    return CountDisagreements({&run}) == 1;
  };
  EXPECT_FALSE(disagrees(AnswerOf(1, 0.95, Outcome::kMatch, 0.97)));
  EXPECT_TRUE(disagrees(AnswerOf(1, 0.89, Outcome::kMatch, 0.97)));
  EXPECT_TRUE(disagrees(AnswerOf(1, 0.95, Outcome::kAmbiguous, 0.97)));
  EXPECT_FALSE(disagrees(AnswerOf(1, 0.40, Outcome::kUnknownPlace, 0.45)));
  EXPECT_TRUE(disagrees(AnswerOf(1, 0.40, Outcome::kUnknownPlace, 0.60)));
  EXPECT_TRUE(disagrees(AnswerOf(1, 0.40, Outcome::kAmbiguous, 0.45)));
  EXPECT_TRUE(disagrees(AnswerOf(1, 0.80, Outcome::kAmbiguous, 0.70)));
}

void ExpectSame(const Drive& a, const Drive& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].frame, b[i].frame);
    EXPECT_EQ(a[i].reference, b[i].reference);
    EXPECT_EQ(a[i].place, b[i].place);
    EXPECT_EQ(a[i].pictures, b[i].pictures);
    for (std::size_t side = 0; side < 2; ++side) {
      const auto& one = a[i].flow.fields[side];
      const auto& two = b[i].flow.fields[side];
      ASSERT_EQ(one.has_value(), two.has_value());
      if (one) {
        EXPECT_EQ(one->vectors.size(), two->vectors.size());
      }
    }
  }
}

TEST(SimulatedDrivesTest, FramesRenderedOnceGiveTheDrivesRenderedAloneAndAreKept) {
  const TemporaryFolder folder;
  const std::string spec = "sim:street,length=3,drive=2";
  const std::vector<SimulatedDriveSpec> specs = {
      {spec}, {spec + ",repeat=3"}, {spec + ",drop=0.3"}, {spec + ",drop_run=2"}};
  const auto together = SimulatedDrives(specs, folder.File(""));
  const auto kept = SimulatedDrives(specs, folder.File(""));
  for (std::size_t i = 0; i < specs.size(); ++i) {
    ExpectSame(together[i], SimulatedDrives({specs[i]}, "")[0]);
    ExpectSame(together[i], kept[i]);
  }
  EXPECT_GT(together[1].size(), together[0].size());
  EXPECT_LT(together[2].size(), together[0].size());
}

TEST(SimulatedDrivesTest, OneCameraAndATailAreLess) {
  const auto drive = SimulatedDrives({{"sim:street,length=5", false, 2}}, "")[0];
  EXPECT_NEAR(drive.front().place, 2.9, 0.1);
  for (const Instant& instant : drive) EXPECT_FALSE(instant.flow.fields[1].has_value());
}

}  // namespace
}  // namespace homing::accuracy
