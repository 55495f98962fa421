#include "homing/localization/route_belief.h"

#include <gtest/gtest.h>

#include "homing/localization/step_window.h"

namespace homing {
namespace {

// All at one step, all directions and speeds.
RouteBelief PeakAt(std::int64_t steps, std::int64_t at) {
  RouteBelief belief;
  belief.Grow(steps, 1.0);
  std::vector<float> factors(static_cast<std::size_t>(steps), 0.0F);
  factors[static_cast<std::size_t>(at)] = 1.0F;
  belief.Weigh(factors);
  return belief;
}

TEST(RouteBeliefTest, MotionKeepsMassAwayFromTheEnds) {
  RouteBelief belief = PeakAt(200, 100);
  EXPECT_NEAR(belief.Mass(), 1, 1e-5);
  for (int i = 0; i < 15; ++i) {
    belief.Move();
  }
  EXPECT_NEAR(belief.Mass(), 1, 1e-4);
}

TEST(RouteBeliefTest, MassThatRunsOffIsGone) {
  RouteBelief belief = PeakAt(20, 10);
  for (int i = 0; i < 40; ++i) {
    belief.Move();
  }
  EXPECT_LT(belief.Mass(), 0.5);
  EXPECT_GE(belief.Mass(), 0);
}

TEST(RouteBeliefTest, HalfMovesTowardsHomeAndHalfAway) {
  RouteBelief belief = PeakAt(400, 200);
  for (int i = 0; i < 30; ++i) {
    belief.Move();
  }
  const auto before = belief.DirectionMass(0, 199);
  const auto after = belief.DirectionMass(201, 399);
  EXPECT_GT(before[0], 0.45);
  EXPECT_LT(before[1], 0.02);
  EXPECT_GT(after[1], 0.45);
  EXPECT_LT(after[0], 0.02);
}

TEST(RouteBeliefTest, SpeedsMoveByTheirStepsOnAverage) {
  RouteBelief belief = PeakAt(400, 100);
  for (int i = 0; i < 60; ++i) {
    belief.Move();
  }
  // Of what moves away from home at once the speed of the outbound journey or nearly so.
  const std::vector<double> mass = belief.StepMass();
  double near_one = 0;
  for (std::size_t s = 100 + 60 - 12; s <= 100 + 60 + 12; ++s) {
    near_one += mass[s];
  }
  EXPECT_GT(near_one, 0.05);
  double beyond = 0;
  for (std::size_t s = 100 + 60 * 3; s < mass.size(); ++s) {
    beyond += mass[s];
  }
  EXPECT_LT(beyond, 0.01);
}

TEST(RouteBeliefTest, GrowthGivesNewStepsTheirMass) {
  RouteBelief belief = PeakAt(10, 5);
  belief.Grow(14, 0.25);
  EXPECT_EQ(belief.step_count(), 14);
  EXPECT_NEAR(belief.Mass(), 2, 1e-5);
  EXPECT_NEAR(belief.StepMass()[12], 0.25, 1e-6);
}

TEST(StepWindowTest, HoldsTheMostMass) {
  const std::vector<double> mass{0, 0.2, 0, 0, 0.1, 0.15, 0.1, 0, 0};
  const StepWindow window = BestWindow(mass, 1);
  EXPECT_EQ(window.step, 5);
  EXPECT_EQ(window.first, 4);
  EXPECT_EQ(window.last, 6);
  EXPECT_NEAR(window.mass, 0.35, 1e-12);
}

TEST(StepWindowTest, LiesAboutTheMiddleOfANarrowMass) {
  std::vector<double> mass(100);
  mass[50] = 0.5;
  mass[52] = 0.5;
  EXPECT_EQ(BestWindow(mass, 10).step, 51);
}

TEST(StepWindowTest, IsCutAtTheEnds) {
  std::vector<double> mass(100);
  mass[1] = 1;
  const StepWindow window = BestWindow(mass, 10);
  EXPECT_EQ(window.step, 1);
  EXPECT_EQ(window.first, 0);
  EXPECT_EQ(window.last, 11);
}

TEST(StepWindowTest, ToleranceOfZeroIsTheMostProbableStep) {
  const StepWindow window = BestWindow({0.1, 0.5, 0.4}, 0);
  EXPECT_EQ(window.step, 1);
  EXPECT_EQ(window.mass, 0.5);
}

TEST(StepWindowTest, NothingHasNoWindow) { EXPECT_LT(BestWindow({}, 10).mass, 0); }

}  // namespace
}  // namespace homing
