#include "homing/localization/place_jump.h"

#include <gtest/gtest.h>

namespace homing {
namespace {

constexpr MapLength kMap{.steps = 1000, .correlation_steps = 5};

BelievedPlace At(std::int64_t step, double mass = 0.9) { return {.step = step, .mass = mass}; }

TEST(PlaceJumpTest, ARobotThatMovesAlongTheMapDoesNotJump) {
  PlaceJump jump;
  for (int step = 0; step < 1000; step += 8) EXPECT_FALSE(jump.Update(At(step), 8, kMap));
}

TEST(PlaceJumpTest, ADistantPlaceIsAJump) {
  PlaceJump jump;
  EXPECT_FALSE(jump.Update(At(500), 1, kMap));
  EXPECT_TRUE(jump.Update(At(600), 1, kMap));
  EXPECT_FALSE(jump.Update(At(601), 1, kMap));
  EXPECT_TRUE(jump.Update(At(501), -1, kMap));
}

TEST(PlaceJumpTest, ANearPlaceIsALagThatIsMadeGood) {
  PlaceJump jump;
  jump.Update(At(500), 1, kMap);
  EXPECT_FALSE(jump.Update(At(540), 1, kMap));
}

TEST(PlaceJumpTest, WhileNoPlaceIsSettledTheRobotMayGoFar) {
  PlaceJump jump;
  jump.Update(At(500), 1, kMap);
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(jump.Update(At(700, 0.4), 1, kMap));
  EXPECT_FALSE(jump.Update(At(700), 1, kMap));
}

TEST(PlaceJumpTest, BeforeAPlaceIsSettledNothingIsAJump) {
  PlaceJump jump;
  EXPECT_FALSE(jump.Update(At(100, 0.6), 1, kMap));
  EXPECT_FALSE(jump.Update(At(900, 0.6), 1, kMap));
}

TEST(PlaceJumpTest, OnALoopTheEndIsBesideTheStart) {
  PlaceJump jump;
  jump.Update(At(995), 1, kMap);
  EXPECT_FALSE(jump.Update(At(3), 1, kMap));
}

TEST(PlaceJumpTest, AnotherJourneyMayLeadAlongTheSameRoad) {
  PlaceJump jump;
  jump.Update(At(100), 1, kMap);
  EXPECT_FALSE(jump.Update({.journey = 1, .step = 900, .mass = 0.9}, 1, kMap));
  EXPECT_TRUE(jump.Update({.journey = 1, .step = 400, .mass = 0.9}, 1, kMap));
}

}  // namespace
}  // namespace homing
