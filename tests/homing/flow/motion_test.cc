#include "homing/flow/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>

#include "tests/homing/flow/flow_pictures.h"

namespace homing {
namespace {

constexpr double kFocal = 277;

// Motion of a sideways camera in one step: metres along its own axes (x right, z ahead), radians.
struct CameraMotion {
  double forward_x = 0;
  double forward_z = 0;
  double pan = 0;
};

// Depth, metres, of what is seen at (x, y), in focal lengths from the centre.
using Depth = std::function<double(double x, double y)>;

double FlatWall(double, double) { return 4; }
// Posts and boxes before a facade.
double Street(double x, double y) { return 4 + 2 * std::sin(9 * x) + std::cos(7 * y); }

FlowField FieldOf(const CameraMotion& motion, const Depth& depth, double noise,
                  std::uint64_t seed) {
  cv::RNG random(seed);
  FlowField field{320, 240, {}};
  for (int i = 0; i < 200; ++i) {
    const double x = random.uniform(-155.0, 155.0) / kFocal;
    const double y = random.uniform(-115.0, 115.0) / kFocal;
    const double z = depth(x, y);
    const double u = (x * motion.forward_z - motion.forward_x) / z + motion.pan * (1 + x * x);
    const double v = y * motion.forward_z / z + motion.pan * x * y;
    const double du = random.gaussian(noise);
    const double dv = random.gaussian(noise);
    const auto start_x = static_cast<float>(159.5 + kFocal * (x - 0.5 * u));
    const auto start_y = static_cast<float>(119.5 + kFocal * (y - 0.5 * v));
    field.vectors.push_back({start_x, start_y, static_cast<float>(start_x + kFocal * u + du),
                             static_cast<float>(start_y + kFocal * v + dv)});
  }
  return field;
}

// A robot that drives `metres` and turns by `pan` in a step: the left camera's x axis points
// ahead, the right one's astern.
ObservedFlow RobotFlow(double metres, double pan, const Depth& depth, double noise) {
  ObservedFlow flow;
  flow.fields[0] = FieldOf({metres, 0, pan}, depth, noise, 1);
  flow.fields[1] = FieldOf({-metres, 0, pan}, depth, noise, 2);
  return flow;
}

ObservedFlow LeftOf(ObservedFlow flow) {
  flow.fields[1].reset();
  return flow;
}

// As if the flow had been sent.
Motion MotionOf(ObservedFlow flow, const std::array<Camera, 2>& cameras) {
  flow.makes_step = HasMoved(flow.fields).value_or(true);
  return ClassifyMotion(flow, cameras);
}

TEST(HasMovedTest, NeedsAMedianOfEnoughVectorsOfEitherCamera) {
  const auto field = [](int still, int moving) {
    FlowField result{400, 300, {}};
    for (int i = 0; i < still; ++i) result.vectors.push_back({10, 10, 10.59F, 10});
    for (int i = 0; i < moving; ++i) result.vectors.push_back({10, 10, 10, 10.61F});
    return result;
  };
  EXPECT_EQ(HasMoved({}), std::nullopt);
  EXPECT_EQ(HasMoved({field(0, 7), field(7, 0)}), std::nullopt);
  EXPECT_EQ(HasMoved({field(0, 8), std::nullopt}), true);
  EXPECT_EQ(HasMoved({field(8, 0), std::nullopt}), false);
  // The upper one of two in the middle.
  EXPECT_EQ(HasMoved({field(4, 4), std::nullopt}), true);
  EXPECT_EQ(HasMoved({field(5, 4), std::nullopt}), false);
  EXPECT_EQ(HasMoved({field(100, 0), field(3, 20)}), true);
  EXPECT_EQ(HasMoved({field(100, 0), field(0, 7)}), false);
}

TEST(ClassifyMotionTest, NoiseAloneIsStanding) {
  EXPECT_EQ(MotionOf(RobotFlow(0, 0, Street, 0.1), {}), Motion::kStanding);
  EXPECT_EQ(MotionOf(LeftOf(RobotFlow(0, 0, Street, 0.2)), {}), Motion::kStanding);
}

TEST(ClassifyMotionTest, NoVectorsTellNothing) {
  EXPECT_EQ(MotionOf({}, {}), Motion::kMoving);
  ObservedFlow blank;
  blank.fields[0] = FlowField{320, 240, {}};
  EXPECT_EQ(MotionOf(blank, {}), Motion::kMoving);
}

TEST(ClassifyMotionTest, WhatMakesNoStepIsStanding) {
  ObservedFlow flow = RobotFlow(0.1, 0, Street, 0.1);
  EXPECT_EQ(ClassifyMotion(flow, {}), Motion::kStanding);
  flow.makes_step = true;
  EXPECT_EQ(ClassifyMotion(flow, {}), Motion::kMoving);
}

TEST(ClassifyMotionTest, AFewVectorsAreNoProofOfStandingNorOfMoving) {
  ObservedFlow flow = RobotFlow(0, 0, FlatWall, 0.1);
  flow.fields[1] = FieldOf({-0.2, 0, 0}, FlatWall, 0.1, 2);
  flow.fields[1]->vectors.resize(5);
  EXPECT_EQ(MotionOf(flow, {}), Motion::kStanding);
  flow.fields[0]->vectors.resize(7);
  EXPECT_EQ(MotionOf(flow, {}), Motion::kMoving);
}

TEST(ClassifyMotionTest, OnePixelAStepIsMoving) {
  const double metres = 4 / kFocal;
  EXPECT_EQ(MotionOf(RobotFlow(metres, 0, FlatWall, 0.1), {}), Motion::kMoving);
  EXPECT_EQ(MotionOf(LeftOf(RobotFlow(metres, 0, FlatWall, 0.1)), {}), Motion::kMoving);
}

TEST(ClassifyMotionTest, DrivingIsMovingAtAnySpeedAndPastAnything) {
  for (const double metres : {0.02, 0.1, 0.3, -0.2}) {
    for (const Depth& depth : {Depth(FlatWall), Depth(Street)}) {
      EXPECT_EQ(MotionOf(RobotFlow(metres, 0, depth, 0.1), {}), Motion::kMoving);
      EXPECT_EQ(MotionOf(LeftOf(RobotFlow(metres, 0, depth, 0.1)), {}), Motion::kMoving);
    }
  }
}

TEST(ClassifyMotionTest, ATurnOnTheSpotIsTurning) {
  for (const double pan : {0.01, 0.05, -0.1}) {
    EXPECT_EQ(MotionOf(RobotFlow(0, pan, Street, 0.1), {}), Motion::kTurning);
    EXPECT_EQ(MotionOf(LeftOf(RobotFlow(0, pan, Street, 0.1)), {}), Motion::kTurning);
  }
}

TEST(ClassifyMotionTest, SomeWrongVectorsDoNotHideATurn) {
  ObservedFlow flow = RobotFlow(0, 0.03, Street, 0.1);
  for (std::size_t i = 0; i < 20; ++i) {
    flow.fields[0]->vectors[10 * i].end_x -= 15;
    flow.fields[1]->vectors[10 * i].end_y += 9;
  }
  EXPECT_EQ(MotionOf(flow, {}), Motion::kTurning);
}

TEST(ClassifyMotionTest, ACurveIsMoving) {
  EXPECT_EQ(MotionOf(RobotFlow(0.1, 0.01, Street, 0.1), {}), Motion::kMoving);
  EXPECT_EQ(MotionOf(LeftOf(RobotFlow(0.1, 0.01, FlatWall, 0.1)), {}), Motion::kMoving);
}

// The turn moves both images further than the drive does.
TEST(ClassifyMotionTest, ADriveThatTurnsPastDistantObjectsIsMoving) {
  const auto distant = [](double, double) { return 12.0; };
  for (const double metres : {0.06, 0.1}) {
    EXPECT_EQ(MotionOf(RobotFlow(metres, 0.03, distant, 0.1), {}), Motion::kMoving);
  }
}

TEST(ClassifyMotionTest, AForwardLookingCameraThatDrivesIsMoving) {
  ObservedFlow flow;
  flow.fields[0] = FieldOf({0, 0.15, 0}, Street, 0.1, 3);
  EXPECT_EQ(MotionOf(flow, {}), Motion::kMoving);
  flow.fields[0] = FieldOf({0, 0.15, 0.01}, Street, 0.1, 4);
  EXPECT_EQ(MotionOf(flow, {}), Motion::kMoving);
}

TEST(ClassifyMotionTest, ACameraThatSeesNothingLeavesItToTheOther) {
  ObservedFlow flow = RobotFlow(0.1, 0, Street, 0.1);
  flow.fields[1]->vectors.resize(3);
  EXPECT_EQ(MotionOf(flow, {}), Motion::kMoving);
  flow = RobotFlow(0, 0.05, Street, 0.1);
  flow.fields[1]->vectors.clear();
  EXPECT_EQ(MotionOf(flow, {}), Motion::kTurning);
}

class StandingNoiseTest : public ::testing::TestWithParam<std::pair<int, double>> {};

// Frames of a robot that stands, with sensor noise, through the tracker.
TEST_P(StandingNoiseTest, IsStanding) {
  const auto [width, sigma] = GetParam();
  const cv::Mat picture = TexturePicture(width, width * 3 / 4, 0, 0, width / 320.0);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    ObservedFlow flow;
    flow.fields[0] = FlowOf(Exposed(picture, 0.8, sigma, 2 * seed + 1),
                            Exposed(picture, 0.8, sigma, 2 * seed + 2));
    ASSERT_GT(flow.fields[0]->vectors.size(), 20U);
    EXPECT_EQ(MotionOf(flow, {}), Motion::kStanding);
  }
}

INSTANTIATE_TEST_SUITE_P(WidthsAndNoise, StandingNoiseTest,
                         ::testing::Values(std::pair(160, 2.0), std::pair(160, 4.0),
                                           std::pair(320, 4.0), std::pair(640, 4.0)));

}  // namespace
}  // namespace homing
