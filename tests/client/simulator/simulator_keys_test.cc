// Keys that may be left out: how the robot drives, where its cameras look, which frames arrive.
#include <gtest/gtest.h>

#include <cmath>

#include "client/simulator/simulator.h"
#include "tests/client/simulator/simulated_images.h"

namespace homing::client {
namespace {

class SimulatorKeysTest : public ::testing::TestWithParam<const char*> {
 protected:
  std::string Scene(const std::string& keys) { return std::string(GetParam()) + keys; }
};
INSTANTIATE_TEST_SUITE_P(Scenes, SimulatorKeysTest,
                         ::testing::Values("sim:street", "sim:landmarks"));

TEST_P(SimulatorKeysTest, TheSameSeedGivesTheSameBytesUnderEveryKey) {
  const std::string keys =
      ",length=20,vary=1,extra=3,yaw=20,yaw_wobble=5,rough=1,repeat=5,drop=0.3,drop_run=10";
  const auto one = Make(Scene(keys));
  const auto two = Make(Scene(keys));
  ASSERT_EQ(one->frame_count(), two->frame_count());
  for (const std::int64_t frame : {0, 20, 50}) {
    EXPECT_EQ(one->RouteMetres(frame), two->RouteMetres(frame));
    for (const Side camera : {Side::kLeft, Side::kRight}) {
      const cv::Mat a = one->RenderCamera(frame, camera);
      const cv::Mat b = two->RenderCamera(frame, camera);
      EXPECT_TRUE(a.empty() ? b.empty() : SameBytes(a, b));
    }
  }
}

TEST_P(SimulatorKeysTest, ARepeatedFrameIsTheSameToTheByte) {
  const auto plain = Make(Scene(",length=20,drive=1"));
  const auto repeating = Make(Scene(",length=20,drive=1,repeat=5"));
  const cv::Mat third = plain->RenderCamera(3, Side::kLeft);
  EXPECT_TRUE(SameBytes(third, repeating->RenderCamera(3, Side::kLeft)));
  EXPECT_TRUE(SameBytes(third, repeating->RenderCamera(4, Side::kLeft)));
  EXPECT_TRUE(
      SameBytes(plain->RenderCamera(4, Side::kLeft), repeating->RenderCamera(5, Side::kLeft)));
}

TEST_P(SimulatorKeysTest, WhatACameraDoesNotGiveIsEmpty) {
  const auto simulator = Make(Scene(",length=20,drop_run=10"));
  int given = 0;
  for (std::int64_t frame = 0; frame < 50; ++frame) {
    const SimulatedInstant instant = simulator->Render(frame);
    given += (instant.images[0].empty() ? 0 : 1) + (instant.images[1].empty() ? 0 : 1);
    EXPECT_EQ(instant.images[0].empty(), simulator->RenderCamera(frame, Side::kLeft).empty());
  }
  EXPECT_EQ(given, 90);
}

TEST_P(SimulatorKeysTest, CamerasTurnTheSameWaySeenFromAbove) {
  // At 180 degrees each looks where the other one did.
  const auto straight = Make(Scene(",length=20,drive=1"));
  const auto turned = Make(Scene(",length=20,drive=1,yaw=180"));
  EXPECT_GT(
      Correlation(straight->RenderCamera(30, Side::kRight), turned->RenderCamera(30, Side::kLeft)),
      0.95);
  // So turned cameras change sides on the way home, as straight ones do.
  const auto out = Make(Scene(",length=20,speed=3.6,fps=4,yaw=30"));
  const auto home = Make(Scene(",length=20,speed=3.6,fps=4,yaw=30,travel=return"));
  EXPECT_GT(Correlation(out->RenderCamera(33, Side::kLeft), home->RenderCamera(47, Side::kRight)),
            0.95);
}

// Mean of the true flow of one camera, x and y, and how it grows away from the centre.
struct FlowFigures {
  double x = 0;
  double expansion = 0;
};
FlowFigures FiguresOf(const cv::Mat& flow) {
  FlowFigures sums;
  int count = 0;
  for (int y = 0; y < flow.rows; ++y) {
    for (int x = 0; x < flow.cols; ++x) {
      const auto f = flow.at<cv::Vec2f>(y, x);
      if (std::isnan(f[0])) continue;
      ++count;
      sums.x += f[0];
      sums.expansion += f[0] * (x - Simulator::kCenterX) + f[1] * (y - Simulator::kCenterY);
    }
  }
  return {sums.x / count, sums.expansion / count};
}

TEST_P(SimulatorKeysTest, ACameraAt90DegreesLooksAheadAndTheOtherBehind) {
  const auto simulator = Make(Scene(",length=20,yaw=90"));
  EXPECT_GT(FiguresOf(simulator->TrueFlow(30, Side::kLeft)).expansion, 10);
  EXPECT_LT(FiguresOf(simulator->TrueFlow(30, Side::kRight)).expansion, -10);
}

TEST_P(SimulatorKeysTest, AYawOfTheRobotMovesBothImagesTheSameWay) {
  const auto straight = Make(Scene(",length=20,fps=10"));
  const auto steering = Make(Scene(",length=20,fps=10,yaw_wobble=8"));
  double most = 0;
  for (const std::int64_t frame : {20, 30, 40, 50, 60}) {
    const auto change = [&](Side camera) {
      return FiguresOf(steering->TrueFlow(frame, camera)).x -
             FiguresOf(straight->TrueFlow(frame, camera)).x;
    };
    const double left = change(Side::kLeft);
    EXPECT_NEAR(left, change(Side::kRight), 1.2) << frame;
    most = std::max(most, std::abs(left));
  }
  EXPECT_GT(most, 1.5);
}

TEST_P(SimulatorKeysTest, BeyondTheEndTheWorldIsThatOfALongerRoute) {
  const auto beyond = Make(Scene(",length=20,extra=20,drive=1"));
  const auto longer = Make(Scene(",length=40,drive=1"));
  EXPECT_TRUE(
      SameBytes(beyond->RenderCamera(150, Side::kLeft), longer->RenderCamera(150, Side::kLeft)));
  const auto plain = Make(Scene(",length=20,drive=1"));
  EXPECT_TRUE(SameBytes(beyond->RenderCamera(9, Side::kLeft), plain->RenderCamera(9, Side::kLeft)));
}

TEST_P(SimulatorKeysTest, RoughGroundShakesTheImageALittle) {
  const auto smooth = Make(Scene(",length=20,drive=1"));
  const auto rough = Make(Scene(",length=20,drive=1,rough=1"));
  double most = 0;
  for (const std::int64_t frame : {10, 20, 30, 40}) {
    const cv::Mat a = smooth->RenderCamera(frame, Side::kLeft);
    const cv::Mat b = rough->RenderCamera(frame, Side::kLeft);
    EXPECT_GT(Correlation(a, b), 0.3) << frame;
    most = std::max(most, MeanDifference(a, b));
  }
  EXPECT_GT(most, 4);
}

}  // namespace
}  // namespace homing::client
