#include "homing/journey/see_landmarks.h"

#include <gtest/gtest.h>

#include <optional>
#include <utility>

#include "homing/flow/camera.h"

namespace homing {
namespace {

// Objects passed at `pixels` a step and, in the lower half of the image, at twice that.
FlowField Passing(float pixels) {
  FlowField field{320, 240, {}};
  for (float x = 10; x < 310; x += 12) {
    for (float y = 10; y < 230; y += 20) {
      field.vectors.push_back({x, y, x + (y < 120 ? pixels : 2 * pixels), y});
    }
  }
  return field;
}

ObservedFlow Flow(std::optional<FlowField> left, std::optional<FlowField> right) {
  ObservedFlow flow;
  flow.fields = {std::move(left), std::move(right)};
  flow.makes_step = true;
  return flow;
}

void ExpectEqual(const std::vector<SeenLandmark>& a, const std::vector<SeenLandmark>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].x, b[i].x);
    EXPECT_EQ(a[i].y, b[i].y);
    EXPECT_EQ(a[i].count, b[i].count);
  }
}

TEST(SeeLandmarksTest, ReturnExchangesTheSidesAndSameKeepsThem) {
  const ObservedFlow flow = Flow(Passing(8), Passing(-5));
  const SeenStep same = SeeLandmarks(flow, {}, Travel::kSame, {});
  const SeenStep home = SeeLandmarks(flow, {}, Travel::kReturn, {});
  ASSERT_EQ(same.motion, Motion::kMoving);
  ASSERT_FALSE(same.landmarks[0].empty());
  ExpectEqual(same.landmarks[0], home.landmarks[1]);
  ExpectEqual(same.landmarks[1], home.landmarks[0]);
  EXPECT_EQ(home.flow.fields[0]->vectors[0].FlowX(), 8);
}

TEST(SeeLandmarksTest, LandmarksAreThoseOfTheRectifiedFlow) {
  Camera turned;
  turned.width = 320;
  turned.height = 240;
  turned.intrinsics = Intrinsics{277, 277, 160, 120};
  turned.yaw_rad = 0.2;
  const FlowField raw = Passing(8);
  const SeenStep seen = SeeLandmarks(Flow(raw, {}), {turned, {}}, Travel::kSame, {});
  ASSERT_EQ(seen.motion, Motion::kMoving);
  ASSERT_FALSE(seen.landmarks[0].empty());
  ExpectEqual(seen.landmarks[0], FindLandmarks(Rectify(raw, turned), {}));
  EXPECT_NE(seen.landmarks[0][0].x, FindLandmarks(raw, {})[0].x);
  EXPECT_TRUE(seen.landmarks[1].empty());
  EXPECT_FALSE(seen.flow.fields[1].has_value());
}

TEST(SeeLandmarksTest, ARobotThatDoesNotDriveSeesNoLandmarks) {
  ObservedFlow standing = Flow(Passing(8), Passing(-8));
  standing.makes_step = false;
  const SeenStep none = SeeLandmarks(standing, {}, Travel::kSame, {});
  EXPECT_EQ(none.motion, Motion::kStanding);
  EXPECT_TRUE(none.landmarks[0].empty() && none.landmarks[1].empty());
  // A turn on the spot moves both images the same way.
  FlowField pan{320, 240, {}};
  for (const FlowVector& v : Passing(8).vectors) {
    pan.vectors.push_back({v.start_x, v.start_y, v.start_x + 8, v.start_y});
  }
  const SeenStep turn = SeeLandmarks(Flow(pan, pan), {}, Travel::kSame, {});
  EXPECT_EQ(turn.motion, Motion::kTurning);
  EXPECT_TRUE(turn.landmarks[0].empty() && turn.landmarks[1].empty());
}

}  // namespace
}  // namespace homing
