#include "client/pilot/pilot.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/client/pilot/answered_pilot.h"

namespace homing::client {
namespace {

using PilotTest = AnsweredPilotTest;

TEST_F(PilotTest, TurnsRoundOnTheSpotAndThenDrivesAhead) {
  Pilot pilot{PilotOptions()};
  EXPECT_EQ(pilot.state(), Pilot::State::kTurningRound);
  const PilotCommand first = Step(pilot);
  EXPECT_EQ(first.speed_mps, 0);
  EXPECT_NE(first.turn_rate, 0);
  Pilot turned = OnItsWay();
  EXPECT_EQ(turned.state(), Pilot::State::kDriving);
  EXPECT_GT(Step(turned).speed_mps, 0.3);
}

TEST_F(PilotTest, DrivesHomeInReverseWithoutATurn) {
  Pilot pilot(InReverse());
  const PilotCommand command = Step(pilot);
  EXPECT_LT(command.speed_mps, -0.3);
  EXPECT_NEAR(command.turn_rate, 0, 1e-9);
}

TEST_F(PilotTest, HeadsBackToThePath) {
  PilotAnswer left = Sure();
  left.path_offset = 0.1;
  Pilot ahead = OnItsWay();
  EXPECT_LT(Step(ahead, left).turn_rate, 0);
  Pilot reverse(InReverse());
  EXPECT_GT(Step(reverse, left).turn_rate, 0);
}

TEST_F(PilotTest, TurnsAgainstTheSumOfTheTurns) {
  Pilot pilot = OnItsWay();
  PilotAnswer turned = Sure();
  turned.turn = 0.1;
  Step(pilot, turned);
  const double once = Step(pilot, turned).turn_rate;
  EXPECT_LT(once, 0);
  EXPECT_GT(pilot.heading(), 0.1);
}

TEST_F(PilotTest, StandsWhenAnswersStopAndGoesOnWhenTheyComeAgain) {
  Pilot pilot = OnItsWay();
  Step(pilot);
  PilotCommand command;
  for (int i = 0; i < 15; ++i) command = Wait(pilot);
  EXPECT_EQ(pilot.state(), Pilot::State::kWaiting);
  EXPECT_EQ(command.speed_mps, 0);
  EXPECT_EQ(command.turn_rate, 0);
  Step(pilot);
  Step(pilot);
  EXPECT_EQ(pilot.state(), Pilot::State::kDriving);
}

// The turns are in the answers where the place is not, so that a stretch that has changed is
// passed.
TEST_F(PilotTest, DrivesOnByTheTurnsWhereThePlaceIsUnknown) {
  Pilot pilot = OnItsWay();
  for (int i = 0; i < 100; ++i) Step(pilot, Sure(pilot.remaining_m()));
  const double begin_m = pilot.remaining_m();
  for (int i = 0; i < 300; ++i) EXPECT_GT(Step(pilot, Lost()).speed_mps, 0) << i;
  EXPECT_EQ(pilot.state(), Pilot::State::kDriving);
  EXPECT_LT(pilot.remaining_m(), begin_m - 10);
}

// Such an answer is a mistake more often than the robot is carried.
TEST_F(PilotTest, APlaceFarOffIsBelievedWhenItIsToldForSomeMetres) {
  Pilot pilot = OnItsWay();
  for (int i = 0; i < 20; ++i) Step(pilot);
  PilotAnswer elsewhere = Sure(30);
  elsewhere.path_offset = 0.3;
  Step(pilot, elsewhere);
  EXPECT_GT(pilot.remaining_m(), 50);
  EXPECT_LT(pilot.offset_m(), 0.5);
  double told_m = 30;
  for (int i = 0; i < 150; ++i) {
    const double before_m = pilot.remaining_m();
    Step(pilot, Sure(told_m));
    const double driven_m = before_m - pilot.remaining_m();
    if (driven_m < 1) told_m -= driven_m;
  }
  EXPECT_LT(pilot.remaining_m(), 30);
}

TEST_F(PilotTest, AWrongPlaceForAMomentIsNoHome) {
  Pilot pilot = OnItsWay();
  for (int i = 0; i < 20; ++i) Step(pilot);
  for (int i = 0; i < 10; ++i) Step(pilot, Sure(0));
  Step(pilot, Sure(pilot.remaining_m()));
  EXPECT_EQ(pilot.state(), Pilot::State::kDriving);
  EXPECT_GT(pilot.remaining_m(), 50);
}

// An answer is no better than its tolerance, which the way driven is for some metres.
TEST_F(PilotTest, APlaceALittleOffIsTakenOverBySteps) {
  Pilot pilot = OnItsWay();
  for (int i = 0; i < 20; ++i) Step(pilot);
  const double before_m = pilot.remaining_m();
  Step(pilot, Sure(before_m + 1));
  EXPECT_LT(pilot.remaining_m(), before_m + 0.3);
  for (int i = 0; i < 100; ++i) Step(pilot, Sure(before_m));
  EXPECT_NEAR(pilot.remaining_m(), before_m, 2.5);
}

TEST_F(PilotTest, WithoutATurnTheHeadingFollowsTheCommands) {
  Pilot pilot = OnItsWay();
  PilotAnswer left = Sure();
  left.path_offset = 0.2;
  left.turn.reset();
  for (int i = 0; i < 10; ++i) Step(pilot, left);
  EXPECT_LT(pilot.heading(), -0.1);
  // Nothing has moved since the reference frame: a later answer reports the turn.
  Pilot standing = OnItsWay();
  left.is_standing = true;
  for (int i = 0; i < 10; ++i) Step(standing, left);
  EXPECT_GT(standing.heading(), pilot.heading());
}

// Covered or frozen cameras: the answers repeat what was known before.
TEST_F(PilotTest, ThePlaceOfARobotWhoseCamerasShowNoMotionIsNotBelievedForLong) {
  Pilot pilot = OnItsWay();
  for (int i = 0; i < 200; ++i) Step(pilot, Sure(pilot.remaining_m()));
  PilotAnswer blind = Sure(pilot.remaining_m());
  blind.turn.reset();
  blind.path_offset = 0.2;
  blind.is_standing = true;
  int driving = 0;
  while (driving < 200 && pilot.state() == Pilot::State::kDriving) {
    Step(pilot, blind);
    ++driving;
  }
  EXPECT_LT(driving, 200);
  EXPECT_LT(std::abs(pilot.heading()), 0.45);
  Step(pilot, Sure(pilot.remaining_m()));
  EXPECT_EQ(pilot.state(), Pilot::State::kDriving);
}

// The map ends there: answers stay at its last steps while the robot drives past them.
TEST_F(PilotTest, TheLastMetreIsDrivenAsCommanded) {
  PilotOptions options;
  options.route_m = 5;
  Pilot pilot = OnItsWay(options);
  PilotAnswer near = Sure();
  near.progress_home = 1 - 0.5 / 5;
  for (int i = 0; i < 200 && pilot.state() != Pilot::State::kHome; ++i) Step(pilot, near);
  EXPECT_EQ(pilot.state(), Pilot::State::kHome);
}

TEST_F(PilotTest, StopsAtHomeForGood) {
  PilotOptions options;
  options.route_m = 2;
  Pilot pilot = OnItsWay(options);
  PilotAnswer home = Sure();
  home.progress_home = 0.9999;
  for (int i = 0; i < 100 && pilot.state() != Pilot::State::kHome; ++i) Step(pilot, home);
  EXPECT_EQ(pilot.state(), Pilot::State::kHome);
  EXPECT_EQ(Step(pilot).speed_mps, 0);
}

TEST_F(PilotTest, IsNeverFasterThanItsLimits) {
  PilotOptions options;
  options.most_speed_mps = 0.4;
  options.most_turn_rate = 0.3;
  Pilot pilot = OnItsWay(options);
  PilotAnswer far_off = Sure();
  far_off.path_offset = 2;
  for (int i = 0; i < 20; ++i) {
    const PilotCommand command = Step(pilot, far_off);
    EXPECT_LE(std::abs(command.speed_mps), 0.4);
    EXPECT_LE(std::abs(command.turn_rate), 0.3);
  }
}

}  // namespace
}  // namespace homing::client
