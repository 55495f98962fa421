#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "client/pilot/pilot.h"

namespace homing::client {
namespace {

// Of five observations a second the tracker would lose the objects at the full rate.
TEST(TurnRateTest, TurnsNoFasterThanItsObservationsShow) {
  for (const double view_s : {0.05, 0.1, 0.2, 0.5}) {
    Pilot pilot{PilotOptions()};
    for (int i = 0; i < 3; ++i) {
      PilotAnswer answer;
      answer.outcome = PilotAnswer::Outcome::kMatch;
      answer.turn = 0;
      answer.sequence = i;
      answer.time_s = i * view_s;
      pilot.Take(answer);
      const double rate = std::abs(pilot.Drive(i * view_s).turn_rate);
      EXPECT_LE(rate * (i == 0 ? 0.2 : view_s), 0.0801) << view_s;
      EXPECT_GE(rate, i == 0 ? 0.1 : std::min(0.7, 0.079 / view_s)) << view_s;
    }
  }
}

}  // namespace
}  // namespace homing::client
