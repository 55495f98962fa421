#include "client/command/flags.h"

#include <gtest/gtest.h>

#include "tests/support/status_matchers.h"

namespace homing::client {
namespace {

using ::testing::HasSubstr;

TEST(CameraFlagTest, ReadsIntrinsics) {
  const auto camera = ParseCamera("277,278,160,120");
  ASSERT_THAT(camera, IsOk());
  EXPECT_EQ(camera->focal_x(), 277);
  EXPECT_EQ(camera->focal_y(), 278);
  EXPECT_EQ(camera->center_x(), 160);
  EXPECT_EQ(camera->center_y(), 120);
  EXPECT_EQ(camera->distortion_size(), 0);
  EXPECT_EQ(camera->yaw_rad(), 0);
}

TEST(CameraFlagTest, ReadsDistortionAndYaw) {
  const auto camera = ParseCamera("277,277,160,120,-0.3,0.1,0.001,-0.002,0.05,yaw=0.2");
  ASSERT_THAT(camera, IsOk());
  ASSERT_EQ(camera->distortion_size(), 5);
  EXPECT_EQ(camera->distortion(0), -0.3);
  EXPECT_EQ(camera->distortion(4), 0.05);
  EXPECT_EQ(camera->yaw_rad(), 0.2);
}

TEST(CameraFlagTest, RefusesOtherForms) {
  for (const char* text : {"", "277", "277,277,160", "a,b,c,d", "277,277,160,120,0.1", "yaw=0.2",
                           "277,277,160,120,yaw=x"}) {
    EXPECT_THAT(ParseCamera(text),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("fx,fy,cx,cy")))
        << text;
  }
}

TEST(JourneyNameTest, SplitsRobotAndJourney) {
  const auto name = ParseJourneyName("robots/a/journeys/b");
  ASSERT_THAT(name, IsOk());
  EXPECT_EQ(name->parent, "robots/a");
  EXPECT_EQ(name->journey_id, "b");
}

TEST(JourneyNameTest, RefusesOtherForms) {
  for (const char* text : {"", "b", "robots/a", "robots/a/journeys/", "robots//journeys/b",
                           "robot/a/journeys/b", "robots/a/journeys/b/c"}) {
    EXPECT_THAT(ParseJourneyName(text), StatusIs(absl::StatusCode::kInvalidArgument,
                                                 HasSubstr("robots/ROBOT/journeys/JOURNEY")))
        << text;
  }
}

TEST(WriterTest, IsTheSameEachTime) {
  EXPECT_FALSE(DefaultWriter().empty());
  EXPECT_EQ(DefaultWriter(), DefaultWriter());
}

}  // namespace
}  // namespace homing::client
