// Answers that keep coming, but are old.
#include <gtest/gtest.h>

#include "client/pilot/pilot.h"

namespace homing::client {
namespace {

// In reverse along the path, with answers each tenth of a second that are `delay_s` old.
class LateAnswersTest : public ::testing::Test {
 protected:
  LateAnswersTest() : pilot_(InReverse()) {}

  static PilotOptions InReverse() {
    PilotOptions options;
    options.turn_round = false;
    return options;
  }

  PilotCommand DriveFor(double seconds, double delay_s) {
    PilotCommand command;
    for (const double end_s = now_s_ + seconds; now_s_ < end_s; now_s_ += 0.1) {
      PilotAnswer answer;
      answer.sequence = sequence_++;
      answer.time_s = now_s_ - delay_s;
      answer.outcome = PilotAnswer::Outcome::kMatch;
      answer.probability = 1;
      answer.progress_home = 0.2;
      answer.turn = 0;
      answer.path_offset = 0;
      pilot_.Take(answer);
      command = pilot_.Drive(now_s_);
    }
    return command;
  }

  Pilot pilot_;
  std::int64_t sequence_ = 0;
  double now_s_ = 100;
};

TEST_F(LateAnswersTest, DrivesByAnswersThatTheCommandsCarryToNow) {
  EXPECT_LT(DriveFor(5, 5).speed_mps, 0);
  EXPECT_EQ(pilot_.state(), Pilot::State::kDriving);
}

TEST_F(LateAnswersTest, StandsWhileAnswersAreOlderThanTheCommandsKept) {
  DriveFor(2, 0.1);
  EXPECT_EQ(pilot_.state(), Pilot::State::kDriving);
  const PilotCommand command = DriveFor(30, 12);
  EXPECT_EQ(pilot_.state(), Pilot::State::kWaiting);
  EXPECT_EQ(command.speed_mps, 0);
  EXPECT_EQ(command.turn_rate, 0);
  EXPECT_LT(DriveFor(2, 0.1).speed_mps, 0);
}

}  // namespace
}  // namespace homing::client
