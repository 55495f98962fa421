#include "homing/localization/aliasing.h"

#include <gmock/gmock.h>

#include <random>

namespace homing {
namespace {

using ::testing::IsEmpty;

FlowProfile RandomProfile(std::mt19937_64& engine) {
  std::uniform_int_distribution<int> share(0, 8);
  std::uniform_int_distribution<int> parallax(4, 12);
  FlowProfile profile;
  for (auto& cell : profile.cells) {
    const int vectors = share(engine);
    cell = vectors == 0 ? 0 : static_cast<std::uint8_t>(vectors | (parallax(engine) << 4));
  }
  return profile;
}

// A step looks half like the one before it.
std::vector<FlowProfile> RandomRoute(int count, int seed) {
  std::mt19937_64 engine(static_cast<std::uint64_t>(seed));
  std::vector<FlowProfile> route;
  for (int step = 0; step < count; ++step) {
    FlowProfile next = RandomProfile(engine);
    for (std::size_t cell = 0; step > 0 && cell < next.cells.size(); ++cell) {
      if (engine() % 2 == 0) next.cells[cell] = route.back().cells[cell];
    }
    route.push_back(next);
  }
  return route;
}

TEST(Aliasing, PlacesAllUnlikeAreKnownAtOnceAndNoneIsAliased) {
  const Aliasing aliasing = AnalyzeAliasing({RandomRoute(200, 1), RandomRoute(200, 2)}, 5);
  ASSERT_TRUE(aliasing.most_steps);
  EXPECT_LE(*aliasing.most_steps, 20);
  EXPECT_LE(*aliasing.median_steps, *aliasing.most_steps);
  EXPECT_EQ(aliasing.indistinct_share, 0);
}

TEST(Aliasing, AStretchThatComesAgainTakesLongerAndIsReportedAsAliased) {
  const std::vector<FlowProfile> plain = RandomRoute(200, 1);
  std::vector<FlowProfile> repeated = plain;
  std::copy(plain.begin() + 20, plain.begin() + 50, repeated.begin() + 120);
  const Aliasing before = AnalyzeAliasing({plain, {}}, 5);
  const Aliasing after = AnalyzeAliasing({repeated, {}}, 5);
  ASSERT_TRUE(before.most_steps);
  ASSERT_TRUE(after.most_steps);
  EXPECT_GT(*after.most_steps, *before.most_steps + 5);
  ASSERT_FALSE(after.aliased_places.empty());
  EXPECT_NEAR(static_cast<double>(std::abs(after.aliased_places[0].first_step -
                                           after.aliased_places[0].second_step)),
              100, 5);
  EXPECT_GE(after.aliased_places[0].confusion, 0.9);
}

TEST(Aliasing, ARouteThatLooksTheSameEverywhereIsNeverTold) {
  std::mt19937_64 engine(3);
  const std::vector<FlowProfile> same(300, RandomProfile(engine));
  const Aliasing aliasing = AnalyzeAliasing({same, {}}, 5);
  EXPECT_FALSE(aliasing.median_steps);
  EXPECT_EQ(aliasing.indistinct_share, 1);
  EXPECT_FALSE(aliasing.aliased_places.empty());
  EXPECT_LE(aliasing.aliased_places.size(), 20U);
}

TEST(Aliasing, NothingIsKnownOfARouteWithoutProfiles) {
  const Aliasing none = AnalyzeAliasing({}, 10);
  EXPECT_FALSE(none.median_steps);
  EXPECT_THAT(none.aliased_places, IsEmpty());
  const Aliasing one = AnalyzeAliasing({RandomRoute(1, 4), {}}, 10);
  EXPECT_EQ(one.median_steps, 1);
}

}  // namespace
}  // namespace homing
