#include "homing/similarity/deviation_model.h"

#include <cmath>
#include <limits>

#include "tests/support/status_matchers.h"

namespace homing {
namespace {

using ::testing::HasSubstr;

TEST(DeviationModelTest, HasThePapersResultAsDefault) {
  const DeviationModel model;
  EXPECT_EQ(model.mu, 2.24);
  EXPECT_EQ(model.sigma, 0.86);
  EXPECT_THAT(Validate(model), IsOk());
}

// Equation (9): Phi at 0, 1 and -2 standard deviations, from tables.
TEST(DeviationModelTest, DistributionIsNormalInTheLogarithm) {
  const DeviationModel model;
  EXPECT_NEAR(Cdf(model, std::exp(2.24)), 0.5, 1e-14);
  EXPECT_NEAR(Cdf(model, std::exp(2.24 + 0.86)), 0.84134474606854293, 1e-14);
  EXPECT_NEAR(Cdf(model, std::exp(2.24 - 2 * 0.86)), 0.02275013194817921, 1e-14);
}

// Equation (10): at delta = e^mu the density is 1 / (e^mu sigma sqrt(2 pi)).
TEST(DeviationModelTest, DensityAtTheLogLocation) {
  const DeviationModel model;
  EXPECT_NEAR(Pdf(model, std::exp(2.24)), 0.398942280401432678 / (9.393331287442784 * 0.86), 1e-12);
  EXPECT_NEAR(Pdf(model, 1.0), 0.398942280401432678 / 0.86 * std::exp(-0.5 * 6.784207679826934),
              1e-10);
}

TEST(DeviationModelTest, DensityIsTheSlopeOfTheDistribution) {
  const DeviationModel model;
  for (const double delta : {0.5, 3.0, 9.0, 40.0, 200.0}) {
    const double h = 1e-5 * delta;
    EXPECT_NEAR((Cdf(model, delta + h) - Cdf(model, delta - h)) / (2 * h), Pdf(model, delta), 1e-7);
  }
}

TEST(DeviationModelTest, NothingLiesBelowZero) {
  const DeviationModel model;
  EXPECT_EQ(Cdf(model, 0), 0);
  EXPECT_EQ(Pdf(model, 0), 0);
  EXPECT_EQ(Pdf(model, -1), 0);
  EXPECT_EQ(Survival(model, 0), 1);
}

TEST(DeviationModelTest, SurvivalKeepsItsDigitsInTheTail) {
  const DeviationModel model{.mu = 0, .sigma = 1};
  // 1 - Phi(10), which 1 - F cannot tell from 0.
  EXPECT_NEAR(Survival(model, std::exp(10.0)) / 7.6198530241605260660e-24, 1, 1e-12);
}

TEST(DeviationModelTest, RefusesInvalidModels) {
  DeviationModel model;
  model.sigma = 0;
  EXPECT_THAT(Validate(model), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("sigma: 0")));
  model = {};
  model.mu = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(Validate(model), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("mu: nan")));
  model = {};
  model.width = -1;
  EXPECT_THAT(Validate(model), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("width")));
}

}  // namespace
}  // namespace homing
