#include "client/command/evaluation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "tests/support/status_matchers.h"

namespace homing::client {
namespace {

using ::testing::HasSubstr;

std::vector<TruePlace> Places(const std::vector<double>& metres) {
  std::vector<TruePlace> places;
  for (const double place : metres) places.push_back({place, {-1, -1}});
  return places;
}

LocalizedAnswer Answer(std::int64_t sequence, std::optional<std::int64_t> step) {
  LocalizedAnswer answer;
  answer.sequence = sequence;
  answer.frame = sequence;
  answer.step = step;
  return answer;
}

TEST(EvaluationTest, ReadsTruth) {
  std::istringstream file(
      "sequence,camera,metres,landmark\n0,left,0.0,3\n0,right,0.0,-1\n1,left,0.5,4\n");
  const auto truth = ReadTruth(file, "truth.csv");
  ASSERT_THAT(truth, IsOk());
  ASSERT_EQ(truth->size(), 2U);
  EXPECT_EQ((*truth)[0].landmarks[0], 3);
  EXPECT_EQ((*truth)[0].landmarks[1], -1);
  EXPECT_DOUBLE_EQ((*truth)[1].metres, 0.5);
}

TEST(EvaluationTest, NamesTheLineOfTruthThatIsWrong) {
  for (const char* line : {"x,left,0,1", "0,middle,0,1", "0,left,far,1", "0,left,0", "-1,left,0,1",
                           "99999999999,left,0,1"}) {
    std::istringstream file(std::string("sequence,camera,metres,landmark\n") + line + "\n");
    EXPECT_THAT(ReadTruth(file, "truth.csv"),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("truth.csv, line 2")))
        << line;
  }
  std::istringstream headless("0,left,0,1\n");
  EXPECT_THAT(ReadTruth(headless, "t"),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("line 1")));
}

TEST(EvaluationTest, ReadsAnswersWithNullSteps) {
  std::istringstream file(
      R"({"sequence":0,"outcome":"AMBIGUOUS","motion":"MOVING","step":null,"probability":0,"similarity":null})"
      "\n"
      R"({"sequence":1,"frame":3,"outcome":"MATCH","motion":"MOVING","step":7,"step_frame":9,"probability":0.93,"landmark":2,"similarity":0.5})"
      "\n");
  const auto answers = ReadAnswers(file, "home.json");
  ASSERT_THAT(answers, IsOk());
  ASSERT_EQ(answers->size(), 2U);
  EXPECT_FALSE((*answers)[0].step.has_value());
  EXPECT_EQ((*answers)[0].frame, 0);
  EXPECT_EQ((*answers)[1].step, 7);
  EXPECT_EQ((*answers)[1].frame, 3);
  EXPECT_EQ((*answers)[1].step_frame, 9);
  EXPECT_EQ((*answers)[1].landmark, 2);
  EXPECT_DOUBLE_EQ((*answers)[1].probability, 0.93);
}

TEST(EvaluationTest, NamesTheAnswerThatIsNoJson) {
  std::istringstream file("{\"sequence\":0}\nnot json\n");
  EXPECT_THAT(ReadAnswers(file, "home.json"),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("home.json, line 2")));
}

TEST(EvaluationTest, PlacesAFrameInTheMiddleBetweenItAndTheOneBefore) {
  const auto truth = Places({0, 1, 3});
  EXPECT_EQ(PlaceOfFrame(truth, 1), 0.5);
  EXPECT_EQ(PlaceOfFrame(truth, 2), 2.0);
  EXPECT_FALSE(PlaceOfFrame(truth, 3).has_value());
  EXPECT_FALSE(PlaceOfFrame(truth, 0).has_value());
}

TEST(EvaluationTest, ComparesTheFramesOfTheAnswerAndOfTheStep) {
  const auto outbound = Places({0, 1, 2, 3});
  const auto home = Places({3, 2, 1, 0});
  // Lines of earlier versions name no frame of the step: it is the one after.
  EXPECT_EQ(Evaluate({Answer(1, 2)}, outbound, home)[0].error_m(), 0.0);
  LocalizedAnswer answer = Answer(0, 1);
  answer.frame = 1;
  answer.step_frame = 3;
  const auto places = Evaluate({answer}, outbound, home);
  EXPECT_EQ(places[0].true_m, 2.5);
  EXPECT_EQ(places[0].error_m(), 0.0);
}

TEST(EvaluationTest, CountsOnlyAfterTheFirstMetresAndCountsTheLostAsWrong) {
  std::vector<EvaluatedPlace> places;
  for (int i = 0; i < 20; ++i) {
    EvaluatedPlace place;
    place.true_m = 100.0 - i;
    if (i != 15) place.believed_m = 100.0 - i + (i == 16 ? 3 : 0.5);
    places.push_back(place);
  }
  const Verdict verdict = Judge(places, 10, 2);
  EXPECT_EQ(verdict.counted, 10);
  EXPECT_EQ(verdict.within, 8);
  EXPECT_DOUBLE_EQ(verdict.share(), 0.8);
  EXPECT_DOUBLE_EQ(verdict.median_error_m, 0.5);
}

TEST(EvaluationTest, NothingCountedIsNoShare) {
  const Verdict verdict = Judge({}, 10, 2);
  EXPECT_EQ(verdict.share(), 0);
  EXPECT_TRUE(std::isnan(verdict.median_error_m));
}

}  // namespace
}  // namespace homing::client
