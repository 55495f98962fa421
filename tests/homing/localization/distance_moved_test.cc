#include "homing/localization/distance_moved.h"

#include <gtest/gtest.h>

namespace homing {
namespace {

TEST(EvidenceWeightTest, CountsTheDistanceInCorrelationLengths) {
  EXPECT_NEAR(EvidenceWeight(1, 6), 0.25, 1e-9);
  EXPECT_NEAR(EvidenceWeight(0.5, 6), 0.125, 1e-9);
  EXPECT_EQ(EvidenceWeight(10, 1), 1);
  EXPECT_GT(EvidenceWeight(0, 6), 0);
}

TEST(DistanceMovedTest, WithoutAReadingThereIsNone) {
  auto route = std::make_shared<RouteScale>();
  const std::shared_ptr<const RouteScale> shared = route;
  const StepMass mass{0, {1}};
  DistanceMoved distance;
  EXPECT_FALSE(distance.Update({&shared, 1}, {&mass, 1}, {}));
  route->sides[0].emplace().usual_readings = {100};
  EXPECT_FALSE(distance.Update({&shared, 1}, {&mass, 1}, {}));
}

}  // namespace
}  // namespace homing
