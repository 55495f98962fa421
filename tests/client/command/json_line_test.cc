#include "client/command/json_line.h"

#include <gtest/gtest.h>

namespace homing::client {
namespace {

TEST(JsonLineTest, RecordHasTheWordsOfTheContract) {
  v1::RecordJourneyResponse answer;
  answer.set_sequence(12);
  answer.set_next_sequence(13);
  answer.set_step(11);
  answer.set_motion(v1::MOTION_MOVING);
  v1::Fingerprint& fingerprint = *answer.add_landmarks()->mutable_fingerprint();
  fingerprint.set_landmark(3);
  fingerprint.set_side(v1::SIDE_LEFT);
  fingerprint.set_x(161.2F);
  fingerprint.set_y(88);
  fingerprint.set_count(94);
  EXPECT_EQ(
      ToJson(answer).dump(),
      R"({"sequence":12,"next_sequence":13,"frame":12,"step":11,"motion":"MOVING","landmarks":)"
      R"([{"landmark":3,"side":"LEFT","x":161.2,"y":88.0,"count":94}]})");
}

TEST(JsonLineTest, RecordOfTheFirstFrameHasNoStep) {
  v1::RecordJourneyResponse answer;
  answer.set_sequence(0);
  answer.set_next_sequence(1);
  EXPECT_EQ(
      ToJson(answer).dump(),
      R"({"sequence":0,"next_sequence":1,"frame":0,"step":null,"motion":"MOVING","landmarks":[]})");
}

TEST(JsonLineTest, LocalizeHasTheWordsOfTheContract) {
  v1::LocalizeResponse answer;
  answer.set_sequence(12);
  answer.set_outcome(v1::OUTCOME_MATCH);
  answer.set_motion(v1::MOTION_MOVING);
  answer.set_journey("robots/R/journeys/J");
  answer.set_step(207);
  answer.set_step_frame(208);
  answer.set_probability(0.93);
  answer.mutable_interval()->set_first(204);
  answer.mutable_interval()->set_last(210);
  answer.set_progress_home(0.41);
  answer.set_direction(v1::DIRECTION_HOMEWARD);
  answer.set_landmark(17);
  answer.set_similarity(0.62);
  v1::Match& match = *answer.add_matches();
  match.set_journey("robots/R/journeys/J");
  match.set_landmark(17);
  match.set_step(207);
  match.set_side(v1::SIDE_LEFT);
  match.set_delta(5.1);
  match.set_p(0.76);
  match.set_p_t(0.62);
  EXPECT_EQ(
      ToJson(answer).dump(),
      R"({"sequence":12,"frame":12,"outcome":"MATCH","motion":"MOVING","journey":"robots/R/journeys/J",)"
      R"("step":207,"step_frame":208,"probability":0.93,"interval":[204,210],"progress_home":0.41,)"
      R"("direction":"HOMEWARD","speed_ratio":null,"turn":null,"path_offset":null,)"
      R"("on_route":0.0,"landmark":17,"similarity":0.62,"matches":[{"journey":)"
      R"("robots/R/journeys/J","landmark":17,"step":207,"side":"LEFT","delta":5.1,"p":0.76,)"
      R"("p_t":0.62}]})");
}

TEST(JsonLineTest, LocalizeIsNullWhereThereIsNothing) {
  v1::LocalizeResponse answer;
  answer.set_outcome(v1::OUTCOME_UNKNOWN_PLACE);
  answer.set_motion(v1::MOTION_TURNING);
  const Json line = ToJson(answer);
  for (const char* key :
       {"journey", "step", "interval", "progress_home", "landmark", "similarity"}) {
    EXPECT_TRUE(line[key].is_null()) << key;
  }
  EXPECT_EQ(line["outcome"], "UNKNOWN_PLACE");
  EXPECT_EQ(line["motion"], "TURNING");
  EXPECT_EQ(line["direction"], "UNKNOWN");
}

TEST(JsonLineTest, JourneySettingsKeepTheirFieldNames) {
  v1::JourneySettings settings;
  settings.mutable_flow()->set_cell_px(8);
  EXPECT_EQ(ToJson(settings)["flow"]["cell_px"], 8);
}

}  // namespace
}  // namespace homing::client
