#include "client/simulator/posed_cameras.h"

#include <gtest/gtest.h>

#include "client/simulator/simulation_spec.h"
#include "tests/client/simulator/simulated_images.h"

namespace homing::client {
namespace {

std::unique_ptr<PosedCameras> CamerasOf(const std::string& spec) {
  return *PosedCameras::Create(*ParseSimulationSpec(spec));
}

TEST(PosedCamerasTest, OnTheRouteTheySeeWhatTheDriveSees) {
  const auto cameras = CamerasOf("sim:street,length=20");
  const auto drive = Make("sim:street,length=20");
  const Pose pose = cameras->route().At(drive->RouteMetres(30));
  for (const Side camera : {Side::kLeft, Side::kRight}) {
    EXPECT_TRUE(SameBytes(cameras->Render(pose, 30, camera), drive->RenderCamera(30, camera)));
  }
}

TEST(PosedCamerasTest, ATurnToTheLeftMovesBothImagesToTheRight) {
  const auto cameras = CamerasOf("sim:street,length=20");
  const Pose from = cameras->route().At(10);
  Pose to = from;
  to.heading += 0.05;
  for (const Side camera : {Side::kLeft, Side::kRight}) {
    const cv::Mat flow = cameras->TrueFlow(from, to, camera);
    EXPECT_NEAR(flow.at<cv::Vec2f>(Simulator::kHeight - 40, Simulator::kWidth / 2)[0],
                Simulator::kFocal * std::tan(0.05), 0.5);
  }
}

TEST(PosedCamerasTest, TheRouteKnowsItsNearestPoint) {
  const auto cameras = CamerasOf("sim:street,length=60,corner=30");
  const Route& route = cameras->route();
  for (const double at : {0.0, 19.0, 33.3, 59.0}) {
    EXPECT_NEAR(route.Nearest(route.At(at).At(0, 1.5)), at, 1e-3);
  }
  EXPECT_NEAR(route.At(30).heading - cameras->route().At(10).heading, 30 * kDegree, 0.2);
}

}  // namespace
}  // namespace homing::client
