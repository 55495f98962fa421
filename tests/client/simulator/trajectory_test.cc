#include "client/simulator/trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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
