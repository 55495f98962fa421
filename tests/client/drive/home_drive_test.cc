#include "client/drive/home_drive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "client/simulator/simulation_spec.h"
#include "tests/drive/local_localizer.h"
#include "tests/drive/projected_eyes.h"

namespace homing::client {
namespace {

class HomeDriveTest : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    cameras_ = *PosedCameras::Create(*ParseSimulationSpec(GetParam()));
    ProjectedEyes eyes(cameras_.get(), {});
    map_ = *drive::RecordOut(cameras_->route(), {.length_m = 20}, &eyes);
  }

  HomeDrive Drive(const HomeDriveOptions& changed = {}) {
    HomeDriveOptions options = changed;
    options.pilot.route_m = 20;
    options.start_left_m = 0.3;
    options.most_s = 90;
    ProjectedEyes eyes(cameras_.get(), {.seed = 2});
    drive::LocalLocalizer localizer(&map_, Travel::kReturn);
    return *DriveHome(options, cameras_->route(), &eyes,
                      [&](const Observation& seen) { return localizer.Answer(seen); });
  }

  // Mean answer, in distances of what is seen, of a robot that drives along beside the path.
  double PathOffset(double left_m) {
    ProjectedEyes eyes(cameras_.get(), {.seed = 3});
    drive::LocalLocalizer localizer(&map_, Travel::kReturn);
    double sum = 0;
    int count = 0;
    std::int64_t frame = 0;
    for (double at = 20; at > 2; at -= 0.1) {
      Pose pose = cameras_->route().At(at);
      // The robot's left is the route's right.
      pose.position = pose.At(0, -left_m);
      pose.heading += kTurn / 2;
      Observation seen = eyes.See(pose, 5000 + frame);
      seen.sequence = frame++;
      const auto answer = localizer.Answer(seen);
      if (answer.ok() && answer->path_offset && at < 12) {
        sum += *answer->path_offset;
        ++count;
      }
    }
    return count == 0 ? std::nan("") : sum / count;
  }

  std::unique_ptr<PosedCameras> cameras_;
  JourneyMap map_;
};

// The sum of the turns in the answers to a robot that follows the path exactly.
double ToldHeading(const std::string& scene, const std::string& changed) {
  const auto out = *PosedCameras::Create(*ParseSimulationSpec(scene));
  const auto home = *PosedCameras::Create(*ParseSimulationSpec(scene + changed));
  ProjectedEyes out_eyes(out.get(), {}), home_eyes(home.get(), {.seed = 2});
  const JourneyMap map = *drive::RecordOut(out->route(), {}, &out_eyes);
  drive::LocalLocalizer localizer(&map, Travel::kReturn);
  double heading = 0;
  std::int64_t frame = 0;
  for (double at = 60; at > 5; at -= 0.1) {
    Pose pose = out->route().At(at);
    pose.heading += kTurn / 2;
    Observation seen = home_eyes.See(pose, 5000 + frame);
    seen.sequence = frame++;
    heading += localizer.Answer(seen)->turn.value_or(0);
  }
  return heading;
}
INSTANTIATE_TEST_SUITE_P(Scenes, HomeDriveTest,
                         ::testing::Values("sim:street,length=20,seed=1",
                                           "sim:landmarks,length=20,seed=2"));

TEST_P(HomeDriveTest, ComesHome) {
  const HomeDrive drive = Drive();
  EXPECT_TRUE(drive.stopped);
  EXPECT_LT(drive.EndFromHome(cameras_->route()), 1);
}

TEST_P(HomeDriveTest, TheSameSeedDrivesTheSamePath) {
  const HomeDrive one = Drive(), two = Drive();
  ASSERT_EQ(one.points.size(), two.points.size());
  EXPECT_EQ(one.points.back().pose.position, two.points.back().pose.position);
}

// Metres over the distance of what is seen, which differs from world to world: it is that of the
// offsets of up to a metre. Landmarks stand so far apart that farther off only their side is sure.
// Many short steps: the distance driven counts, not the number of observations.
TEST_P(HomeDriveTest, TheFirstOffsetComesSoon) {
  constexpr double kStepM = 0.05;
  ProjectedEyes eyes(cameras_.get(), {.seed = 3});
  drive::LocalLocalizer localizer(&map_, Travel::kReturn);
  double driven_m = 0;
  for (std::int64_t frame = 0; driven_m < 10; driven_m += kStepM) {
    Pose pose = cameras_->route().At(20 - driven_m);
    pose.heading += kTurn / 2;
    Observation seen = eyes.See(pose, 5000 + frame);
    seen.sequence = frame++;
    const auto answer = localizer.Answer(seen);
    if (answer.ok() && answer->path_offset) break;
  }
  EXPECT_LT(driven_m, 3);
}

// A view that is turned resembles another place: the robot must learn its heading before the filter
// leaves the right place.
TEST_P(HomeDriveTest, TheFirstViewsTellTheHeading) {
  for (const double askew : {-0.17, 0.17}) {
    ProjectedEyes eyes(cameras_.get(), {.seed = 3});
    drive::LocalLocalizer localizer(&map_, Travel::kReturn);
    Pose pose = cameras_->route().At(20);
    pose.heading += kTurn / 2 + askew;
    double heading = 0;
    for (std::int64_t frame = 0; frame < 4; ++frame) {
      Observation seen = eyes.See(pose, 5000 + frame);
      seen.sequence = frame;
      heading += localizer.Answer(seen)->turn.value_or(0);
      pose.position = pose.At(0.1, 0);
    }
    EXPECT_GT(heading / askew, 0.25);
    EXPECT_LT(heading / askew, 1.25);
  }
}

TEST_P(HomeDriveTest, PathOffsetGrowsWithTheOffsetAndIsNearTheTruth) {
  constexpr std::array kLeftM{-2.0, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0};
  const double sure_m = std::string(GetParam()).find("street") == std::string::npos ? 1 : 2;
  std::array<double, kLeftM.size()> told{};
  std::ranges::transform(kLeftM, told.begin(),
                         [this](double left_m) { return PathOffset(left_m); });
  double both = 0, squares = 0;
  for (std::size_t i = 0; i < kLeftM.size(); ++i) {
    EXPECT_TRUE(i == 0 || told[i] > told[i - 1]) << kLeftM[i];
    if (std::abs(kLeftM[i]) > 1) continue;
    both += kLeftM[i] * told[i];
    squares += told[i] * told[i];
  }
  for (std::size_t i = 0; i < kLeftM.size(); ++i) {
    if (std::abs(kLeftM[i]) > sure_m) continue;
    EXPECT_NEAR(told[i] * both / squares, kLeftM[i], 0.2);
  }
}

// What has gone from one side looks like a bend of the path, or like a turn.
TEST(ToldHeadingTest, IsThatBesideThePathWhereLandmarksHaveGone) {
  for (const char* scene :
       {"sim:landmarks,length=60,seed=31", "sim:landmarks,length=60,seed=31,corner=30"}) {
    EXPECT_NEAR(ToldHeading(scene, ",drive=7,remove=0.25"), 0, 0.1) << scene;
  }
}

// The answers of a lost robot that turns on the spot, seen by one camera alone, add up to the
// turns.
TEST(ToldHeadingTest, CountsATurnThatOneCameraSeesOnceWhereThePlaceIsUnknown) {
  const auto out = *PosedCameras::Create(*ParseSimulationSpec("sim:street,length=40,seed=1"));
  const auto elsewhere = *PosedCameras::Create(*ParseSimulationSpec("sim:street,length=40,seed=5"));
  ProjectedEyes out_eyes(out.get(), {}), eyes(elsewhere.get(), {.seed = 2});
  const JourneyMap map = *drive::RecordOut(out->route(), {.length_m = 40}, &out_eyes);
  drive::LocalLocalizer localizer(&map, Travel::kReturn);
  Pose pose = elsewhere->route().At(40);
  pose.heading += kTurn / 2;
  double heading = 0;
  bool is_turning = false;
  std::int64_t frame = 0;
  const auto see = [&](int count, double driven_m, double turned, bool one_camera) {
    PilotAnswer::Outcome outcome{};
    for (int i = 0; i < count; ++i) {
      pose.heading += turned;
      pose.position = pose.At(driven_m, 0);
      Observation seen = eyes.See(pose, 5000 + frame);
      seen.sequence = frame++;
      if (one_camera) std::get<FlowField>(seen.views[1]).vectors.clear();
      const PilotAnswer answer = *localizer.Answer(seen);
      heading += answer.turn.value_or(0);
      outcome = answer.outcome;
      is_turning = answer.is_turning;
    }
    return outcome;
  };
  ASSERT_EQ(see(150, 0.1, 0, false), PilotAnswer::Outcome::kUnknownPlace);
  heading = 0;
  see(60, 0.1, 0.005, false);
  EXPECT_NEAR(heading, 0.3, 0.05);
  see(4, 0, 0.06, true);
  EXPECT_TRUE(is_turning);
  ASSERT_EQ(see(20, 0.05, 0, false), PilotAnswer::Outcome::kUnknownPlace);
  EXPECT_NEAR(heading, 0.54, 0.08);
}

}  // namespace
}  // namespace homing::client
