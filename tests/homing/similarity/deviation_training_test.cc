#include "homing/similarity/deviation_training.h"

#include <algorithm>
#include <cmath>

#include "tests/support/status_matchers.h"

namespace homing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

// A pinhole of 100 px: at 3.6 km/h the point, 2.5 m ahead, is 1.5 m ahead after 1 s and 1.3 m after
// 1.2 s; halfway, at 10 m, 14 px right of the centre, and 5 px below it.
TEST(DeviationTrainingTest, MidpointIsThatOfAPinhole) {
  TrainingOptions options;
  options.focal_px = 100;
  options.lateral_offset_m = 2.5;
  options.vertical_offset_m = 0.5;
  options.elapsed_s = 1;
  options.frame_interval_s = 0.2;
  const ImagePoint point = TrainingMidpoint(options, 3.6, 10);
  EXPECT_NEAR(point.x, 160 + 14, 1e-12);
  EXPECT_NEAR(point.y, 120 + 5, 1e-12);
}

// Equations (7), (8): the mean of the three is (2, 4).
TEST(DeviationTrainingTest, DeviationsAreDistancesFromTheMean) {
  EXPECT_THAT(DeviationsFromMean({{-1, 0}, {5, 8}, {2, 4}}), ElementsAre(5, 5, 0));
}

TEST(DeviationTrainingTest, FitIsMeanAndDeviationOfTheLogarithm) {
  const auto model = FitDeviationModel({std::exp(1.0), std::exp(3.0)});
  ASSERT_THAT(model, IsOk());
  EXPECT_NEAR(model->mu, 2, 1e-12);
  EXPECT_NEAR(model->sigma, 1, 1e-12);
  EXPECT_EQ(model->observations, 2);
  // Phi(-1) = 0.158655: the empirical step from 0 to 1/2 is 0.341345 above it.
  EXPECT_NEAR(model->ks_distance, 0.341344746068543, 1e-12);
}

TEST(DeviationTrainingTest, RefusesDeviationsThatNoLogNormalFits) {
  EXPECT_THAT(FitDeviationModel({2, 2, 2}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("sigma")));
  EXPECT_THAT(FitDeviationModel({0, 2, 3}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("mu")));
}

TEST(DeviationTrainingTest, DefaultGeometryReachesThePapersModelOver101Seeds) {
  std::vector<double> mus;
  std::vector<double> sigmas;
  int near = 0;
  for (std::uint64_t seed = 1; seed <= 101; ++seed) {
    TrainingOptions options;
    options.seed = seed;
    const auto result = TrainDeviationModel(options);
    ASSERT_THAT(result, IsOk());
    mus.push_back(result->model.mu);
    sigmas.push_back(result->model.sigma);
    near += std::fabs(mus.back() - 2.24) <= 0.10 && std::fabs(sigmas.back() - 0.86) <= 0.10 ? 1 : 0;
  }
  EXPECT_NEAR(Median(mus), 2.24, 0.05);
  EXPECT_NEAR(Median(sigmas), 0.86, 0.05);
  EXPECT_GE(near, 91);
  RecordProperty("median_mu", std::to_string(Median(mus)));
  RecordProperty("median_sigma", std::to_string(Median(sigmas)));
}

TEST(DeviationTrainingTest, SameOptionsGiveTheSameModel) {
  const auto first = TrainDeviationModel({});
  const auto second = TrainDeviationModel({});
  ASSERT_THAT(first, IsOk());
  ASSERT_THAT(second, IsOk());
  EXPECT_EQ(first->model, second->model);
  EXPECT_EQ(first->deviations_px, second->deviations_px);
  EXPECT_EQ(first->deviations_px.size(), 1000u);
  EXPECT_EQ(first->model.width, 320);
  EXPECT_EQ(first->model.height, 240);
  EXPECT_LT(first->model.ks_distance, 0.15);
  EXPECT_GT(first->model.ks_distance, 0);
}

TEST(DeviationTrainingTest, AnotherSeedGivesAnotherModel) {
  TrainingOptions options;
  options.seed = 2;
  EXPECT_NE(TrainDeviationModel(options)->model.mu, TrainDeviationModel({})->model.mu);
}

TEST(DeviationTrainingTest, NamesTheFieldAndTheLimit) {
  TrainingOptions options;
  options.observations = 9;
  EXPECT_THAT(TrainDeviationModel(options),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       HasSubstr("observations: 9 must be in [10, 1000000]")));
  options = {};
  options.focal_px = 0;
  EXPECT_THAT(Validate(options), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("focal")));
  options = {};
  options.distance_mean_m = 1;
  EXPECT_THAT(Validate(options),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("distance_mean_m: 1")));
}

}  // namespace
}  // namespace homing
