// A pilot that gets an answer every tenth of a second.
#ifndef TESTS_CLIENT_PILOT_ANSWERED_PILOT_H_
#define TESTS_CLIENT_PILOT_ANSWERED_PILOT_H_

#include <gtest/gtest.h>

#include <cstdint>

#include "client/pilot/pilot.h"

namespace homing::client {

// Answers every tenth of a second, and the command that follows each.
class AnsweredPilotTest : public ::testing::Test {
 protected:
  static PilotOptions InReverse() {
    PilotOptions options;
    options.turn_round = false;
    return options;
  }

  // On the path, at the begin of the way home, unless `answer` says otherwise.
  PilotCommand Step(Pilot& pilot, PilotAnswer answer = Sure()) {
    answer.sequence = sequence_++;
    answer.time_s = now_s_;
    pilot.Take(answer);
    return Wait(pilot);
  }
  PilotCommand Wait(Pilot& pilot) {
    const PilotCommand command = pilot.Drive(now_s_);
    now_s_ += 0.1;
    return command;
  }
  // Of a pilot that has turned round.
  Pilot OnItsWay(const PilotOptions& options = {}) {
    Pilot pilot(options);
    while (pilot.state() == Pilot::State::kTurningRound) {
      PilotAnswer turning = Sure();
      turning.is_turning = true;
      turning.turn = 0.1 * Wait(pilot).turn_rate;
      Step(pilot, turning);
    }
    return pilot;
  }

  static PilotAnswer Sure() {
    PilotAnswer answer;
    answer.outcome = PilotAnswer::Outcome::kMatch;
    answer.probability = 1;
    answer.progress_home = 0.01;
    answer.turn = 0;
    answer.path_offset = 0;
    return answer;
  }

  static PilotAnswer Lost() {
    PilotAnswer answer;
    answer.outcome = PilotAnswer::Outcome::kUnknownPlace;
    answer.turn = 0;
    return answer;
  }
  static PilotAnswer Sure(double remaining_m) {
    PilotAnswer answer = Sure();
    answer.progress_home = 1 - remaining_m / 60;
    return answer;
  }

  std::int64_t sequence_ = 0;
  double now_s_ = 0;
};

}  // namespace homing::client

#endif  // TESTS_CLIENT_PILOT_ANSWERED_PILOT_H_
