#include "homing/matching/survival_bound.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace homing {
namespace {

// Near, far, and beyond both ends of the table.
TEST(SurvivalBoundTest, HoldsTheSurvivalBetweenItsBounds) {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<float> log2_squared(-40, 40);
  for (const DeviationModel& model : {DeviationModel{}, DeviationModel{.mu = 0.5, .sigma = 0.2},
                                      DeviationModel{.mu = 5, .sigma = 3}}) {
    const SurvivalBound bound(model);
    for (int i = 0; i < 20000; ++i) {
      const float squared = std::exp2(log2_squared(engine));
      const double survival = Survival(model, std::sqrt(double{squared}));
      ASSERT_GE(double{bound.At(squared)}, survival * (1 - 1e-7)) << squared;
      ASSERT_LE(double{bound.LeastAt(squared)}, survival * (1 + 1e-7)) << squared;
    }
  }
}

TEST(SurvivalBoundTest, IsTightWhereMatchesAre) {
  const DeviationModel model;
  const SurvivalBound bound(model);
  for (float squared = 0.1F; squared < 400; squared *= 1.01F) {
    const double survival = Survival(model, std::sqrt(double{squared}));
    EXPECT_LE(double{bound.At(squared)}, survival * 1.06);
    EXPECT_GE(double{bound.LeastAt(squared)}, survival * 0.94);
  }
}

TEST(SurvivalBoundTest, ReachesTheLastDistanceThatHasTheShare) {
  const SurvivalBound bound{DeviationModel{}};
  for (double share = 0.01; share <= 1; share += 0.01) {
    const float reach = bound.ReachOf(share);
    EXPECT_LT(double{bound.At(reach)}, share);
    EXPECT_GE(double{bound.At(std::nextafter(reach, 0.0F))}, share);
  }
  EXPECT_EQ(bound.ReachOf(0), std::numeric_limits<float>::infinity());
}

TEST(SurvivalBoundTest, DistanceOfNothingIsCertain) {
  const SurvivalBound bound{DeviationModel{}};
  EXPECT_EQ(bound.At(0), 1);
}

}  // namespace
}  // namespace homing
