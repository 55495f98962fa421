#include "homing/localization/followed_place.h"

#include <gtest/gtest.h>

namespace homing {
namespace {

constexpr double kCorrelation = 5;

BelievedPlace Likely(std::int64_t step, double mass = 0.9) { return {.step = step, .mass = mass}; }

TEST(FollowedPlaceTest, APlaceThatMovesAsTheRobotDoesIsFollowed) {
  FollowedPlace place;
  EXPECT_TRUE(place.Update(Likely(500), 1, kCorrelation, true));
  for (int step = 499; step > 300; --step) {
    EXPECT_TRUE(place.Update(Likely(step), -1, kCorrelation, false));
  }
}

TEST(FollowedPlaceTest, ItBeginsWhereTheRobotIsSurelyOnItsRoute) {
  FollowedPlace place;
  EXPECT_FALSE(place.Update(Likely(500), 1, kCorrelation, false));
  EXPECT_FALSE(place.Update(Likely(501), 1, kCorrelation, false));
  EXPECT_TRUE(place.Update(Likely(502), 1, kCorrelation, true));
}

TEST(FollowedPlaceTest, AJumpEndsIt) {
  FollowedPlace place;
  place.Update(Likely(500), 1, kCorrelation, true);
  EXPECT_FALSE(place.Update(Likely(520), 1, kCorrelation, false));
  EXPECT_FALSE(place.Update(Likely(521), 1, kCorrelation, false));
}

TEST(FollowedPlaceTest, APlaceThatStaysWhileTheRobotDrivesIsNotFollowed) {
  FollowedPlace place;
  place.Update(Likely(500), 1, kCorrelation, true);
  EXPECT_FALSE(place.Update(Likely(500), 20, kCorrelation, false));
}

TEST(FollowedPlaceTest, SeveralPossiblePlacesEndIt) {
  FollowedPlace place;
  place.Update(Likely(500), 1, kCorrelation, true);
  EXPECT_FALSE(place.Update(Likely(501, 0.6), 1, kCorrelation, false));
  EXPECT_FALSE(place.Update(Likely(502), 1, kCorrelation, false));
}

TEST(FollowedPlaceTest, AnotherJourneyIsAnotherPlace) {
  FollowedPlace place;
  place.Update(Likely(500), 1, kCorrelation, true);
  EXPECT_FALSE(place.Update({.journey = 1, .step = 501, .mass = 0.9}, 1, kCorrelation, false));
}

}  // namespace
}  // namespace homing
