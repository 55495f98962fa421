#include "client/simulator/simulator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/client/simulator/simulated_images.h"

namespace homing::client {
namespace {

class SimulatorTest : public ::testing::TestWithParam<const char*> {
 protected:
  std::string Scene(const std::string& keys = "") { return std::string(GetParam()) + keys; }
};
INSTANTIATE_TEST_SUITE_P(Scenes, SimulatorTest, ::testing::Values("sim:street", "sim:landmarks"));

TEST_P(SimulatorTest, TheSameSpecGivesTheSameBytesInAnyOrder) {
  const auto one = Make(Scene(",length=30,wobble=0.2"));
  const auto two = Make(Scene(",length=30,wobble=0.2"));
  const cv::Mat late = two->RenderCamera(77, Side::kRight);
  for (const std::int64_t frame : {0, 77}) {
    const SimulatedInstant a = one->Render(frame);
    const SimulatedInstant b = two->Render(frame);
    EXPECT_TRUE(SameBytes(a.images[0], b.images[0]));
    EXPECT_TRUE(SameBytes(a.images[1], b.images[1]));
    EXPECT_EQ(a.truth[0].landmark, b.truth[0].landmark);
  }
  EXPECT_TRUE(SameBytes(late, one->RenderCamera(77, Side::kRight)));
}

TEST_P(SimulatorTest, AnotherDriveDiffersInNoiseAndLightOnly) {
  const auto one = Make(Scene(",length=30"));
  const auto two = Make(Scene(",length=30,drive=8"));
  const cv::Mat a = one->RenderCamera(50, Side::kLeft);
  const cv::Mat b = two->RenderCamera(50, Side::kLeft);
  EXPECT_FALSE(SameBytes(a, b));
  EXPECT_GT(MeanDifference(a, b), 1);
  EXPECT_LT(MeanDifference(a, b), 30);
}

TEST_P(SimulatorTest, AnotherSeedIsAnotherRoute) {
  const auto one = Make(Scene(",length=30,drive=1"));
  const auto two = Make(Scene(",length=30,drive=1,seed=2"));
  EXPECT_GT(MeanDifference(one->RenderCamera(50, Side::kLeft), two->RenderCamera(50, Side::kLeft)),
            4);
}

TEST_P(SimulatorTest, ImagesAreGreyAndOfTheCamerasSize) {
  const SimulatedInstant instant = Make(Scene())->Render(3);
  for (const cv::Mat& image : instant.images) {
    EXPECT_EQ(image.type(), CV_8UC1);
    EXPECT_EQ(image.size(), cv::Size(320, 240));
  }
  EXPECT_NEAR(instant.time_s, 0.6, 1e-12);
}

TEST_P(SimulatorTest, OutboundMetresGrowWithTimeAndReturnMetresShrink) {
  const auto out = Make(Scene(",length=20,speed=3.6,fps=4"));
  ASSERT_EQ(out->frame_count(), 81);
  EXPECT_NEAR(out->RouteMetres(0), 0, 1e-9);
  EXPECT_NEAR(out->RouteMetres(10), 2.5, 1e-9);
  EXPECT_NEAR(out->RouteMetres(80), 20, 1e-9);
  const auto home = Make(Scene(",length=20,speed=3.6,fps=4,travel=return"));
  ASSERT_EQ(home->frame_count(), 81);
  EXPECT_NEAR(home->RouteMetres(0), 20, 1e-9);
  EXPECT_NEAR(home->RouteMetres(10), 17.5, 1e-9);
  EXPECT_NEAR(home->RouteMetres(80), 0, 1e-9);
}

TEST_P(SimulatorTest, OnReturnTheLeftCameraSeesTheRightSideUnmirrored) {
  const auto out = Make(Scene(",length=20,speed=3.6,fps=4"));
  const auto home = Make(Scene(",length=20,speed=3.6,fps=4,travel=return"));
  for (const std::int64_t frame : {8, 33, 60}) {
    const SimulatedInstant there = out->Render(frame);
    const SimulatedInstant back = home->Render(80 - frame);
    ASSERT_NEAR(there.route_m, back.route_m, 1e-9);
    EXPECT_EQ(there.truth[0].landmark, back.truth[1].landmark);
    EXPECT_EQ(there.truth[1].landmark, back.truth[0].landmark);
    // Alike but for noise and light, and not mirrored.
    EXPECT_GT(Correlation(there.images[0], back.images[1]), 0.95);
    cv::Mat mirrored;
    cv::flip(back.images[1], mirrored, 1);
    EXPECT_LT(Correlation(there.images[0], mirrored), 0.95);
  }
}

TEST_P(SimulatorTest, OnReturnTheFlowIsReversed) {
  const auto out = Make(Scene(",length=20,speed=3.6,fps=4"));
  const auto home = Make(Scene(",length=20,speed=3.6,fps=4,travel=return"));
  const cv::Mat there = out->TrueFlow(40, Side::kLeft);
  const cv::Mat back = home->TrueFlow(40, Side::kRight);
  const auto seen = there.at<cv::Vec2f>(230, 160);
  EXPECT_LT(seen[0], -10);
  EXPECT_NEAR(seen[0], -back.at<cv::Vec2f>(230, 160)[0], 0.3);
}

TEST_P(SimulatorTest, AStopStandsInTheMiddleWhileNoiseGoesOn) {
  const auto simulator = Make(Scene(",length=20,speed=3.6,fps=4,stop=5"));
  ASSERT_EQ(simulator->frame_count(), 101);
  EXPECT_NEAR(simulator->RouteMetres(40), 10, 1e-9);
  EXPECT_NEAR(simulator->RouteMetres(60), 10, 1e-9);
  EXPECT_NEAR(simulator->RouteMetres(64), 11, 1e-9);
  const cv::Mat flow = simulator->TrueFlow(50, Side::kLeft);
  int seen = 0;
  for (int y = 0; y < flow.rows; ++y) {
    for (int x = 0; x < flow.cols; ++x) {
      const auto f = flow.at<cv::Vec2f>(y, x);
      if (!std::isnan(f[0])) {
        ++seen;
        ASSERT_NEAR(std::hypot(f[0], f[1]), 0, 1e-4);
      }
    }
  }
  EXPECT_GT(seen, 20000);
  EXPECT_FALSE(SameBytes(simulator->RenderCamera(50, Side::kLeft),
                         simulator->RenderCamera(51, Side::kLeft)));
}

TEST_P(SimulatorTest, RemovedLandmarksAreNotSeenAndTheOthersKeepTheirNumbers) {
  const auto numbers = [](const Simulator& simulator) {
    std::set<int> seen;
    for (std::int64_t frame = 0; frame < simulator.frame_count(); frame += 10) {
      const SimulatedInstant instant = simulator.Render(frame);
      seen.insert({instant.truth[0].landmark, instant.truth[1].landmark});
    }
    seen.erase(-1);
    return seen;
  };
  const auto all = numbers(*Make(Scene(",length=60")));
  const auto some = numbers(*Make(Scene(",length=60,remove=0.5")));
  const auto none = numbers(*Make(Scene(",length=60,remove=1")));
  EXPECT_GT(all.size(), 8U);
  EXPECT_GT(some.size(), 0U);
  EXPECT_LT(some.size(), all.size());
  EXPECT_TRUE(none.empty());
}

TEST_P(SimulatorTest, AShorterRouteIsTheBeginningOfALongerOne) {
  const auto longer = Make(Scene(",length=60,drive=1"));
  const auto shorter = Make(Scene(",length=20,drive=1"));
  EXPECT_TRUE(
      SameBytes(longer->RenderCamera(40, Side::kLeft), shorter->RenderCamera(40, Side::kLeft)));
}

TEST_P(SimulatorTest, AWobbleSwaysAndTurnsTheRobot) {
  const auto straight = Make(Scene(",length=20,drive=1"));
  const auto wobbling = Make(Scene(",length=20,drive=1,wobble=1"));
  EXPECT_EQ(straight->RouteMetres(30), wobbling->RouteMetres(30));
  double most = 0;
  for (const std::int64_t frame : {10, 30, 50}) {
    most = std::max(most, MeanDifference(straight->RenderCamera(frame, Side::kLeft),
                                         wobbling->RenderCamera(frame, Side::kLeft)));
  }
  EXPECT_GT(most, 4);
}

}  // namespace
}  // namespace homing::client
