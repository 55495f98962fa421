#include "homing/localization/route_belief.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "homing/localization/step_window.h"

namespace homing {
namespace {

// Probability an observation that the speed changes.
constexpr double kChange = 0.01;

// Weighs steps alone: the odometer says nothing.
constexpr std::array<double, 2> kBothWays{1, 1};
StepMass Weigh(RouteBelief& belief, const std::vector<float>& factors,
               const std::array<double, 2>& directions = kBothWays) {
  const std::vector<std::int16_t> no_ratios(factors.size(), SpeedEvidence::kNoRatio);
  return belief.Weigh(factors, no_ratios, SpeedEvidence(0.1), directions);
}

// All at one step, all directions and speeds.
RouteBelief PeakAt(std::int64_t steps, std::int64_t at) {
  RouteBelief belief;
  belief.Grow(steps, 1.0);
  std::vector<float> factors(static_cast<std::size_t>(steps), 0.0F);
  factors[static_cast<std::size_t>(at)] = 1.0F;
  Weigh(belief, factors);
  return belief;
}

TEST(RouteBeliefTest, AWayThatTheFlowDoesNotShowMayBeLong) {
  RouteBelief belief = PeakAt(200, 100);
  EXPECT_NEAR(belief.MoveUnseen(0), 0, 1e-6);
  const StepMass mass = belief.Masses();
  const auto between = [&mass](std::int64_t first, std::int64_t last) {
    double sum = 0;
    for (std::int64_t step = first; step <= last; ++step) {
      sum += double{mass.mass[static_cast<std::size_t>(step - mass.first)]};
    }
    return sum;
  };
  EXPECT_GT(between(110, 140), 0.15);
  EXPECT_GT(between(60, 90), 0.15);
  EXPECT_NEAR(between(60, 140), 1, 1e-3);
}

TEST(RouteBeliefTest, DirectionsAreWeighed) {
  RouteBelief belief = PeakAt(200, 100);
  Weigh(belief, std::vector<float>(200, 1.0F), {0.5, 1.5});
  const std::array<double, 2> mass = belief.DirectionMass(0, 199);
  EXPECT_NEAR(mass[1] / mass[0], 3, 1e-4);
}

TEST(RouteBeliefTest, MotionKeepsMassAwayFromTheEnds) {
  RouteBelief belief = PeakAt(200, 100);
  EXPECT_NEAR(belief.Mass(), 1, 1e-5);
  for (int i = 0; i < 10; ++i) {
    belief.Move(kChange);
  }
  EXPECT_NEAR(belief.Mass(), 1, 1e-4);
}

TEST(RouteBeliefTest, MoveLosesMassOnlyBeyondTheEnds) {
  RouteBelief inside = PeakAt(200, 100);
  for (int i = 0; i < 10; ++i) {
    EXPECT_NEAR(inside.Move(kChange), 0, 1e-4);
  }
  RouteBelief at_the_end = PeakAt(200, 199);
  const double before = at_the_end.Mass();
  const double lost = at_the_end.Move(kChange);
  EXPECT_GT(lost, 0.2);
  EXPECT_LT(lost, 0.6);
  EXPECT_NEAR(at_the_end.Mass(), before * (1 - lost), 1e-5);
}

TEST(RouteBeliefTest, AddPutsMassAtThePlaceAndInTheDirectionAsked) {
  RouteBelief belief = PeakAt(100, 10);
  belief.Scale(0.25);
  belief.Add({.first = 95, .last = 120, .homeward = false, .outward = true, .mass = 0.75});
  EXPECT_NEAR(belief.Mass(), 1, 1e-5);
  const auto added = belief.DirectionMass(95, 99);
  EXPECT_NEAR(added[0], 0, 1e-6);
  EXPECT_NEAR(added[1], 0.75, 1e-5);
}

TEST(RouteBeliefTest, TheOdometerSetsTheSpeed) {
  for (const double speed : {0.25, 1.0, 4.0}) {
    RouteBelief belief = PeakAt(400, 200);
    const auto ratio = SpeedEvidence::IndexOf(static_cast<int>(20 * std::log2(speed)));
    const std::vector<float> factors(400, 1.0F);
    const std::vector<std::int16_t> ratios(400, ratio);
    for (int i = 0; i < 5; ++i) belief.Weigh(factors, ratios, SpeedEvidence(0.02), kBothWays);
    EXPECT_NEAR(std::log2(belief.mean_speed().absolute / speed), 0, 0.3) << speed;
  }
}

TEST(RouteBeliefTest, MassThatRunsOffIsGone) {
  RouteBelief belief = PeakAt(20, 10);
  for (int i = 0; i < 40; ++i) {
    belief.Move(kChange);
  }
  EXPECT_LT(belief.Mass(), 0.5);
  EXPECT_GE(belief.Mass(), 0);
}

TEST(RouteBeliefTest, HalfMovesTowardsHomeAndHalfAway) {
  RouteBelief belief = PeakAt(400, 200);
  for (int i = 0; i < 30; ++i) {
    belief.Move(kChange);
  }
  const auto before = belief.DirectionMass(0, 199);
  const auto after = belief.DirectionMass(201, 399);
  // Of the fourteen speeds one is standing, and the fastest have left the route.
  EXPECT_GT(before[0], 0.4);
  EXPECT_LT(before[1], 0.02);
  EXPECT_NEAR(after[1], before[0], 0.01);
  EXPECT_LT(after[0], 0.02);
}

TEST(RouteBeliefTest, SpeedsMoveByTheirStepsOnAverage) {
  RouteBelief belief = PeakAt(400, 100);
  for (int i = 0; i < 60; ++i) {
    belief.Move(kChange);
  }
  // Of what moves away from home at once the speed of the outbound journey or nearly so.
  const std::vector<float> mass = belief.Masses().mass;
  double near_one = 0;
  for (std::size_t s = 100 + 60 - 12; s <= 100 + 60 + 12; ++s) {
    near_one += double{mass[s]};
  }
  // One of twenty-eight states moves so: all speeds are alike before the odometer is read.
  EXPECT_NEAR(near_one, 1.0 / 28, 0.02);
}

TEST(RouteBeliefTest, ARobotSeldomChangesItsSpeed) {
  RouteBelief belief = PeakAt(800, 100);
  for (int i = 0; i < 100; ++i) {
    belief.Move(kChange);
  }
  // What has gone at the speed of the outbound journey.
  std::vector<float> factors(800, 0.0F);
  std::fill(factors.begin() + 195, factors.begin() + 206, 1.0F);
  const double before = Weigh(belief, factors).Sum();
  for (int i = 0; i < 200; ++i) {
    belief.Move(kChange);
  }
  const std::vector<float> mass = belief.Masses().mass;
  EXPECT_GT(std::accumulate(mass.begin() + 375, mass.begin() + 426, 0.0), 0.2 * before);
}

TEST(RouteBeliefTest, GrowthGivesNewStepsTheirMass) {
  RouteBelief belief = PeakAt(10, 5);
  belief.Grow(14, 0.25);
  EXPECT_EQ(belief.step_count(), 14);
  EXPECT_NEAR(belief.Mass(), 2, 1e-5);
  EXPECT_NEAR(belief.Masses().mass[12], 0.25, 1e-6);
}

TEST(RouteBeliefTest, AFocusHoldsTheSameAsAllSteps) {
  RouteBelief all = PeakAt(500, 250);
  all.AddToEach(1e-7);
  RouteBelief focused = all;
  focused.Focus(1e-5, focused.Masses());
  EXPECT_TRUE(focused.IsFocused());
  EXPECT_EQ(focused.focus_size(), 1);
  for (int i = 0; i < 20; ++i) {
    all.Move(kChange, 1e-8);
    focused.Move(kChange, 1e-8);
  }
  EXPECT_LT(focused.focus_size(), 500);
  EXPECT_NEAR(focused.Mass(), all.Mass(), 1e-5);
  focused.Unfocus();
  ASSERT_EQ(focused.focus_size(), 500);
  const StepMass expected = all.Masses();
  const StepMass found = focused.Masses();
  // The ends, where mass runs off, apart.
  for (std::size_t s = 200; s < 300; ++s) {
    EXPECT_NEAR(found.mass[s], expected.mass[s], 1e-7 + 1e-3 * double{expected.mass[s]}) << s;
  }
}

TEST(RouteBeliefTest, AFocusGrowsAtTheEndOfTheJourney) {
  RouteBelief belief = PeakAt(100, 99);
  belief.Focus(1e-5, belief.Masses());
  belief.Grow(120, 0.01);
  for (int i = 0; i < 10; ++i) {
    belief.Move(kChange);
  }
  const auto moved = belief.DirectionMass(105, 119);
  EXPECT_GT(moved[1], 0.1);
}

TEST(RouteBeliefTest, WhatIsInNoFocusIsLeftBeyond) {
  RouteBelief belief;
  belief.Grow(100, 1e-8);
  belief.Focus(1e-5, belief.Masses());
  EXPECT_EQ(belief.focus_size(), 0);
  belief.Move(kChange, 1e-9);
  EXPECT_NEAR(belief.Mass(), 100 * 1.1e-8, 1e-12);
  EXPECT_TRUE(belief.Masses().mass.empty());
  belief.Unfocus();
  EXPECT_NEAR(belief.Mass(), 100 * 1.1e-8, 1e-12);
}

TEST(StepWindowTest, OfAFocusIsCutAtTheEndsOfTheJourneyOnly) {
  const StepMass mass{40, {0.25F, 0.5F, 0.25F}};
  const StepWindow window = BestWindow(mass, 10, 45);
  EXPECT_EQ(window.step, 41);
  EXPECT_EQ(window.first, 31);
  EXPECT_EQ(window.last, 44);
  EXPECT_NEAR(window.mass, 1, 1e-6);
}

TEST(StepWindowTest, HoldsTheMostMass) {
  const StepMass mass{0, {0, 0.2F, 0, 0, 0.1F, 0.15F, 0.1F, 0, 0}};
  const StepWindow window = BestWindow(mass, 1, 9);
  EXPECT_EQ(window.step, 5);
  EXPECT_EQ(window.first, 4);
  EXPECT_EQ(window.last, 6);
  EXPECT_NEAR(window.mass, 0.35, 1e-6);
}

TEST(StepWindowTest, OfManyThatHoldAllLiesAboutTheMiddleOfTheMass) {
  StepMass mass{0, std::vector<float>(100)};
  mass.mass[50] = 0.375;
  mass.mass[54] = 0.625;
  EXPECT_EQ(BestWindow(mass, 10, 100).step, 53);
}

// A little mass far off would draw the window to its side by half its width.
TEST(StepWindowTest, AThinTailDoesNotMoveIt) {
  StepMass mass{0, std::vector<float>(100)};
  mass.mass[50] = 0.999F;
  mass.mass[60] = 0.001F;
  EXPECT_EQ(BestWindow(mass, 5, 100).step, 50);
  EXPECT_EQ(BestWindow(mass, 8, 100).step, 50);
}

TEST(StepWindowTest, IsCutAtTheEnds) {
  StepMass mass{0, std::vector<float>(100)};
  mass.mass[1] = 1;
  const StepWindow window = BestWindow(mass, 10, 100);
  EXPECT_EQ(window.step, 1);
  EXPECT_EQ(window.first, 0);
  EXPECT_EQ(window.last, 11);
}

TEST(StepWindowTest, ToleranceOfZeroIsTheMostProbableStep) {
  const StepWindow window = BestWindow({0, {0.1F, 0.5F, 0.4F}}, 0, 3);
  EXPECT_EQ(window.step, 1);
  EXPECT_EQ(window.mass, 0.5);
}

TEST(StepWindowTest, NothingHasNoWindow) { EXPECT_LT(BestWindow({}, 10, 0).mass, 0); }

}  // namespace
}  // namespace homing
