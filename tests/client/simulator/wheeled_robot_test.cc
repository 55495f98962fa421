#include "client/simulator/wheeled_robot.h"

#include <gtest/gtest.h>

namespace homing::client {
namespace {

constexpr WheeledRobotOptions kIdeal{.lag_s = 0, .slip = 0, .noise = 0};

TEST(WheeledRobotTest, AnIdealOneDrivesWhatIsCommanded) {
  WheeledRobot robot(kIdeal, {});
  robot.Drive({.speed_mps = 1, .turn_rate = 0}, 3);
  EXPECT_NEAR(robot.pose().position[0], 3, 1e-9);
  robot.Drive({.speed_mps = 0, .turn_rate = 0.5}, 2);
  EXPECT_NEAR(robot.pose().heading, 1, 1e-9);
  EXPECT_NEAR(robot.pose().position[0], 3, 1e-9);
}

TEST(WheeledRobotTest, FollowsCommandsLate) {
  WheeledRobotOptions late = kIdeal;
  late.lag_s = 0.5;
  WheeledRobot robot(late, {});
  robot.Drive({.speed_mps = 1, .turn_rate = 0}, 0.5);
  EXPECT_NEAR(robot.motion().speed_mps, 0.63, 0.02);
}

TEST(WheeledRobotTest, SlipsAndTurnsBecauseOfIt) {
  WheeledRobotOptions slipping = kIdeal;
  slipping.slip = 0.2;
  WheeledRobot robot(slipping, {});
  robot.Drive({.speed_mps = 1, .turn_rate = 0}, 5);
  EXPECT_LT(robot.pose().position[0], 4.95);
  EXPECT_GT(robot.pose().position[0], 3.5);
  EXPECT_NE(robot.pose().heading, 0);
}

TEST(WheeledRobotTest, TheSameSeedDrivesTheSamePath) {
  WheeledRobot one({.seed = 3}, {}), two({.seed = 3}, {}), other({.seed = 4}, {});
  for (WheeledRobot* robot : {&one, &two, &other}) {
    robot->Drive({.speed_mps = 1, .turn_rate = 0.1}, 4);
  }
  EXPECT_EQ(one.pose().position, two.pose().position);
  EXPECT_NE(one.pose().position, other.pose().position);
}

}  // namespace
}  // namespace homing::client
