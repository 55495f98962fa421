#include "homing/localization/direction_evidence.h"

#include <gtest/gtest.h>

#include <vector>

namespace homing {
namespace {

// All of it moves by `pixels` to the right.
ProfileMaker FieldThatMoves(float pixels) {
  FlowField field{.width = 320, .height = 240, .vectors = {}};
  for (int i = 0; i < 20; ++i) {
    const auto at = static_cast<float>(20 + 12 * i);
    field.vectors.push_back({at, at / 2, at + pixels, at / 2});
  }
  return ProfileMaker(field);
}

// Two opposite cameras that drove away from home: the image of the left one moved to the left.
RouteScale TwoCameras() {
  RouteScale route;
  for (const std::size_t side : {0U, 1U}) {
    const std::vector<FlowProfile> map(20, FieldThatMoves(side == 0 ? -3 : 3).Make());
    route.sides[side].emplace().odometer = CameraOdometer(map);
  }
  return route;
}

TEST(DirectionFactorsTest, SignsOfTheMapMeanAwayFromHome) {
  const auto away = DirectionFactors(TwoCameras(), {FieldThatMoves(-2), FieldThatMoves(4)}, 1);
  EXPECT_GT(away[1], 3 * away[0]);
  const auto home = DirectionFactors(TwoCameras(), {FieldThatMoves(2), FieldThatMoves(-4)}, 1);
  EXPECT_GT(home[0], 3 * home[1]);
}

TEST(DirectionFactorsTest, ATurnCancels) {
  const auto turn = DirectionFactors(TwoCameras(), {FieldThatMoves(5), FieldThatMoves(5)}, 1);
  EXPECT_DOUBLE_EQ(turn[0], turn[1]);
}

TEST(DirectionFactorsTest, ALightObservationSaysLess) {
  const SeenProfiles seen{FieldThatMoves(-2), FieldThatMoves(4)};
  const auto whole = DirectionFactors(TwoCameras(), seen, 1);
  const auto light = DirectionFactors(TwoCameras(), seen, 0.1);
  EXPECT_GT(whole[1], light[1]);
  EXPECT_GT(light[1], 1);
}

TEST(DirectionFactorsTest, WithoutACameraBothAreOne) {
  EXPECT_EQ(DirectionFactors(TwoCameras(), {}, 1), (std::array<double, 2>{1, 1}));
  EXPECT_EQ(DirectionFactors({}, {FieldThatMoves(1), {}}, 1), (std::array<double, 2>{1, 1}));
}

}  // namespace
}  // namespace homing
