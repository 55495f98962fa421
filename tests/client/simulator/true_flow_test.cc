#include "client/simulator/true_flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "client/simulator/scene_simulator.h"

namespace homing::client {
namespace {

Scene Empty(std::vector<Surface> surfaces) {
  return {std::move(surfaces), {.contrast = 0}, {.contrast = 0}, 200};
}

Surface Wall(double distance_m, double half_width_m) {
  return {Parallelogram{{-half_width_m, distance_m, 0}, {2 * half_width_m, 0, 0}, {0, 0, 20}},
          Material()};
}

View LeftView(const Scene& scene, double route_m, double heading = 0) {
  return {scene, route_m, LookAside({{route_m, 0}, heading}, 1, Side::kLeft)};
}

TEST(TrueFlowTest, AWallMovesByFocalLengthTimesStepOverDistance) {
  const Scene scene = Empty({Wall(10, 50)});
  const cv::Mat flow = FlowBetween(LeftView(scene, 0), LeftView(scene, 0.2));
  const auto seen = flow.at<cv::Vec2f>(20, 160);
  EXPECT_NEAR(seen[0], -277 * 0.2 / 10, 1e-4);
  EXPECT_NEAR(seen[1], 0, 1e-4);
}

TEST(TrueFlowTest, TheGroundMovesLessTheFartherItIs) {
  const Scene scene = Empty({});
  const cv::Mat flow = FlowBetween(LeftView(scene, 0), LeftView(scene, 0.2));
  // Row y sees the ground at 277 / (y - 119.5) m.
  EXPECT_NEAR(flow.at<cv::Vec2f>(230, 160)[0], -0.2 * (230 - 119.5), 1e-4);
  EXPECT_NEAR(flow.at<cv::Vec2f>(140, 160)[0], -0.2 * (140 - 119.5), 1e-4);
}

TEST(TrueFlowTest, TheSkyHasNoneAndTheSkylineOnlyTurns) {
  const Scene scene = Empty({});
  const cv::Mat moved = FlowBetween(LeftView(scene, 0), LeftView(scene, 0.2));
  EXPECT_TRUE(std::isnan(moved.at<cv::Vec2f>(10, 160)[0]));
  EXPECT_NEAR(moved.at<cv::Vec2f>(119, 160)[0], 0, 1e-4);
  const cv::Mat turned = FlowBetween(LeftView(scene, 0), LeftView(scene, 0, 0.01));
  // Turning left moves the world to the right.
  EXPECT_NEAR(turned.at<cv::Vec2f>(119, 160)[0], 277 * std::tan(0.01), 0.01);
}

TEST(TrueFlowTest, WhatIsHiddenNextHasNone) {
  // From x = 0.2 the near edge at (1, 4) covers the far wall up to x = 2.2, from 0 up to 2.5.
  const Scene scene = Empty({Wall(10, 50), Wall(4, 1)});
  const cv::Mat leaving = FlowBetween(LeftView(scene, 0.2), LeftView(scene, 0));
  const auto pixel_of = [](double x_m, double from_m) {
    return static_cast<int>(std::lround((x_m - from_m) / 10 * 277 + Simulator::kCenterX));
  };
  EXPECT_TRUE(std::isnan(leaving.at<cv::Vec2f>(60, pixel_of(2.35, 0.2))[0]));
  EXPECT_NEAR(leaving.at<cv::Vec2f>(60, pixel_of(2.7, 0.2))[0], 277 * 0.02, 1e-4);
}

// Mean absolute difference of an image and the next one drawn back by a flow, brightness equalised.
double WarpError(const cv::Mat& image, const cv::Mat& next, const cv::Mat& flow, bool use_flow) {
  std::vector<cv::Vec2d> pairs;
  cv::Vec2d sum(0, 0);
  for (int y = 0; y < flow.rows; ++y) {
    for (int x = 0; x < flow.cols; ++x) {
      const auto f = flow.at<cv::Vec2f>(y, x);
      if (std::isnan(f[0])) {
        continue;
      }
      const double tx = std::clamp(x + (use_flow ? double{f[0]} : 0), 0.0, flow.cols - 1.001);
      const double ty = std::clamp(y + (use_flow ? double{f[1]} : 0), 0.0, flow.rows - 1.001);
      const int x0 = static_cast<int>(tx);
      const int y0 = static_cast<int>(ty);
      const double a = tx - x0;
      const double b = ty - y0;
      const auto at = [&](int dy, int dx) {
        return static_cast<double>(next.at<std::uint8_t>(y0 + dy, x0 + dx));
      };
      const double value =
          (1 - b) * ((1 - a) * at(0, 0) + a * at(0, 1)) + b * ((1 - a) * at(1, 0) + a * at(1, 1));
      pairs.emplace_back(image.at<std::uint8_t>(y, x), value);
      sum += pairs.back();
    }
  }
  EXPECT_GT(pairs.size(), 20000U);
  double error = 0;
  for (const cv::Vec2d& pair : pairs) {
    error += std::abs(pair[0] - pair[1] * sum[0] / sum[1]);
  }
  return error / static_cast<double>(pairs.size());
}

class TrueFlowOfScenesTest : public ::testing::TestWithParam<const char*> {};

TEST_P(TrueFlowOfScenesTest, DrawsTheNextImageBackOntoThisOne) {
  auto spec = ParseSimulationSpec(GetParam());
  ASSERT_TRUE(spec.ok());
  const auto simulator = Simulator::Create(*spec);
  ASSERT_TRUE(simulator.ok());
  for (const std::int64_t frame : {30, 61, 95}) {
    for (const Side camera : {Side::kLeft, Side::kRight}) {
      const cv::Mat image = (*simulator)->RenderCamera(frame, camera);
      const cv::Mat next = (*simulator)->RenderCamera(frame + 1, camera);
      const cv::Mat flow = (*simulator)->TrueFlow(frame, camera);
      const double error = WarpError(image, next, flow, true);
      // Noise of sigma 2 in both images: mean absolute difference up to 2.3.
      EXPECT_LT(error, 3.2) << frame;
      EXPECT_LT(error, WarpError(image, next, flow, false) - 0.2) << frame;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, TrueFlowOfScenesTest,
                         ::testing::Values("sim:street,length=40", "sim:landmarks,length=40",
                                           "sim:street,length=40,wobble=0.5,travel=return",
                                           "sim:landmarks,length=40,seed=5,speed=6",
                                           "sim:street,length=40,yaw=30,yaw_wobble=4",
                                           "sim:landmarks,length=40,yaw=-40,travel=return",
                                           "sim:street,length=40,rough=1,vary=1",
                                           "sim:landmarks,length=40,rough=2,yaw_wobble=5"));

}  // namespace
}  // namespace homing::client
