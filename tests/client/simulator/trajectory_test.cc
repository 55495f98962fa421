#include "client/simulator/trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace homing::client {
namespace {

TEST(TrajectoryTest, AnOffsetIsToTheLeftOfTheOutboundPathWhicheverTheTravel) {
  const Route route(20, {});
  for (const bool travel_return : {false, true}) {
    SimulationSpec spec;
    spec.length_m = 20;
    spec.offset_m = 1.5;
    spec.travel_return = travel_return;
    const Pose pose = Trajectory(spec, 1).At(10, route);
    EXPECT_NEAR(pose.position[1], 1.5, 1e-9);
    EXPECT_NEAR(pose.heading, 0, 1e-12);
  }
}

TEST(TrajectoryTest, AWobbleKeepsWithinItsAmplitudeAndReachesIt) {
  const Route route(60, {});
  SimulationSpec spec;
  spec.length_m = 60;
  spec.wobble_m = 0.5;
  const Trajectory trajectory(spec, 1);
  double sway = 0;
  double yaw = 0;
  for (std::int64_t frame = 0; frame < trajectory.frame_count(); ++frame) {
    const Pose pose = trajectory.At(frame, route);
    sway = std::max(sway, std::abs(pose.position[1]));
    yaw = std::max(yaw, std::abs(pose.heading));
  }
  EXPECT_NEAR(sway, 0.5, 0.01);
  EXPECT_NEAR(yaw, 0.025, 0.001);
}

SimulationSpec SpecOf(const std::string& text) {
  const auto spec = ParseSimulationSpec(text);
  EXPECT_TRUE(spec.ok()) << spec.status();
  return spec.value_or(SimulationSpec());
}

TEST(TrajectoryTest, AVaryingSpeedReachesItsLimitsSmoothlyAndTheEnd) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const SimulationSpec spec = SpecOf("sim:street,length=60,speed=3.6,fps=20,vary=1");
    const Trajectory trajectory(spec, seed);
    double slowest = 9;
    double fastest = 0;
    double last = 0;
    for (std::int64_t i = 0; i + 1 < trajectory.frame_count(); ++i) {
      const double speed = 20 * (trajectory.RouteMetres(i + 1) - trajectory.RouteMetres(i));
      if (i > 0) {
        EXPECT_LT(std::abs(speed - last), 0.15);
      }
      slowest = std::min(slowest, speed);
      fastest = std::max(fastest, speed);
      last = speed;
    }
    EXPECT_NEAR(slowest, 0.3, 0.01);
    EXPECT_NEAR(fastest, 2, 0.01);
    EXPECT_NEAR(trajectory.RouteMetres(trajectory.frame_count() - 1), 60, 0.11);
  }
}

TEST(TrajectoryTest, SpeedsVaryOtherwiseOnAnotherDriveAndLessWithASmallerShare) {
  const SimulationSpec spec = SpecOf("sim:street,length=60,vary=1");
  EXPECT_GT(std::abs(Trajectory(spec, 1).RouteMetres(100) - Trajectory(spec, 2).RouteMetres(100)),
            0.1);
  const Trajectory half(SpecOf("sim:street,length=60,speed=3.6,fps=20,vary=0.5"), 1);
  for (std::int64_t i = 0; i + 2 < half.frame_count(); ++i) {
    const double speed = 20 * (half.RouteMetres(i + 1) - half.RouteMetres(i));
    EXPECT_GT(speed, std::sqrt(0.3) - 0.01);
    EXPECT_LT(speed, std::sqrt(2.0) + 0.01);
  }
}

TEST(TrajectoryTest, AnExtraStretchFollowsTheEndOfTheRoute) {
  const Trajectory out(SpecOf("sim:street,length=20,speed=3.6,fps=4,extra=10"), 1);
  ASSERT_EQ(out.frame_count(), 121);
  EXPECT_NEAR(out.RouteMetres(0), 0, 1e-9);
  EXPECT_NEAR(out.RouteMetres(120), 30, 1e-9);
  const Trajectory home(SpecOf("sim:street,length=20,speed=3.6,fps=4,extra=10,travel=return"), 1);
  EXPECT_NEAR(home.RouteMetres(0), 20, 1e-9);
  EXPECT_NEAR(home.RouteMetres(120), -10, 1e-9);
}

TEST(TrajectoryTest, ARobotThatSteersGoesWhereItHeads) {
  const Route route(60, {});
  const Trajectory trajectory(SpecOf("sim:street,length=60,speed=3.6,fps=20,yaw_wobble=6"), 1);
  double most = 0;
  for (std::int64_t i = 0; i + 1 < trajectory.frame_count(); ++i) {
    const Pose here = trajectory.At(i, route);
    const Pose next = trajectory.At(i + 1, route);
    const Vector2 step = next.position - here.position;
    EXPECT_NEAR(std::atan2(step[1], step[0]), 0.5 * (here.heading + next.heading), 0.003);
    most = std::max(most, std::abs(here.heading));
  }
  EXPECT_NEAR(most, 6 * kDegree, 0.2 * kDegree);
}

TEST(RouteTest, ABendingRouteKeepsItsLengthAndFollowsItsHeading) {
  const Route route(100, {0.08, 90, 1});
  double length = 0;
  for (double s = 0; s < 100; s += 0.01) {
    const Vector2 step = route.At(s + 0.01).position - route.At(s).position;
    length += cv::norm(step);
    ASSERT_NEAR(std::atan2(step[1], step[0]), route.At(s + 0.005).heading, 1e-5) << s;
  }
  EXPECT_NEAR(length, 100, 1e-3);
}

}  // namespace
}  // namespace homing::client
