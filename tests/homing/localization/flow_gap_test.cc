#include "homing/localization/flow_gap.h"

#include <gtest/gtest.h>

namespace homing {
namespace {

// `count` vectors that move by `pixels` to the right.
ProfileMaker FieldThatMoves(float pixels, int count) {
  FlowField field{.width = 320, .height = 240, .vectors = {}};
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<float>(20 + i);
    field.vectors.push_back({at, at / 2, at + pixels, at / 2});
  }
  return ProfileMaker(field);
}

SeenProfiles Opposite(float pixels, int count) {
  return {FieldThatMoves(-pixels, count), FieldThatMoves(pixels, count)};
}

class FlowGapTest : public ::testing::Test {
 protected:
  FlowGapTest() {
    for (int i = 0; i < 10; ++i) EXPECT_FALSE(gap_.Update(Opposite(10, 100)));
  }
  FlowGap gap_;
};

TEST_F(FlowGapTest, FewVectorsThatMoveAnyWayFollowAGap) {
  EXPECT_TRUE(gap_.Update({FieldThatMoves(10, 40), FieldThatMoves(20, 40)}));
  EXPECT_TRUE(gap_.Update(Opposite(-10, 40)));
  EXPECT_FALSE(gap_.Update(Opposite(10, 100)));
}

TEST_F(FlowGapTest, FewVectorsThatMoveAsBeforeAreAPoorerScene) {
  EXPECT_FALSE(gap_.Update(Opposite(10, 45)));
  FlowGap other = gap_;
  EXPECT_TRUE(other.Update(Opposite(10, 10)));
}

TEST_F(FlowGapTest, ATurnOrAReversalThatKeepsItsVectorsIsNoGap) {
  EXPECT_FALSE(gap_.Update({FieldThatMoves(10, 90), FieldThatMoves(20, 90)}));
  EXPECT_FALSE(gap_.Update(Opposite(-10, 90)));
}

TEST_F(FlowGapTest, ASceneThatStaysPoorIsNoGapForLong) {
  int gaps = 0;
  for (int i = 0; i < 30; ++i) {
    gaps += gap_.Update({FieldThatMoves(10, 20), FieldThatMoves(20, 20)}) ? 1 : 0;
  }
  EXPECT_GT(gaps, 0);
  EXPECT_LT(gaps, 15);
}

TEST_F(FlowGapTest, OneCameraShowsNoGap) {
  EXPECT_FALSE(gap_.Update({FieldThatMoves(10, 5), std::nullopt}));
}

}  // namespace
}  // namespace homing
