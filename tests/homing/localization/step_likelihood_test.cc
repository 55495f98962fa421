#include "homing/localization/step_likelihood.h"

#include <cmath>

#include "homing/similarity/similarity.h"
#include "tests/support/status_matchers.h"

namespace homing {
namespace {

// No outliers, not tempered: the bare product of relative factors.
constexpr LikelihoodOptions kBare{.floor = 1e-3, .outlier_share = 0, .temper = 1};

Fingerprint At(float x, std::int32_t count) {
  return {.x = x, .y = 50, .count = count, .landmark = 0};
}

SeenLandmark SeenAt(float x, int count) {
  SeenLandmark seen;
  seen.x = x;
  seen.y = 50;
  seen.count = count;
  return seen;
}

// One step for each list of left fingerprints.
JourneyMap LeftMap(const std::vector<std::vector<Fingerprint>>& steps) {
  JourneyMap map;
  for (const std::vector<Fingerprint>& fingerprints : steps) {
    JourneyStep step{
        .step = map.step_count(), .motion = Motion::kMoving, .fingerprints = {}, .profiles = {}};
    for (Fingerprint f : fingerprints) {
      f.landmark = static_cast<std::int32_t>(map.landmarks().size() + step.fingerprints.size());
      step.fingerprints.push_back({Side::kLeft, f, 0});
    }
    EXPECT_THAT(map.Append(step), IsOk());
  }
  return map;
}

std::vector<float> Likelihoods(const JourneyMap& map, const std::vector<SeenLandmark>& left,
                               const LikelihoodOptions& options = kBare) {
  const std::string name = "n";
  const JourneyRef ref{&name, &map};
  StepLikelihood likelihood(options);
  likelihood.Compute({&ref, 1}, {left, {}});
  return likelihood.of(0);
}

double Pt(const SeenLandmark& seen, const Fingerprint& stored) {
  return Compare(
             MeanAndCount{double{seen.x}, double{seen.y}, static_cast<double>(seen.count)},
             MeanAndCount{double{stored.x}, double{stored.y}, static_cast<double>(stored.count)},
             {})
      .p_t;
}

TEST(FactorTableTest, IsSimilarityWithAFloor) {
  for (const double mu : {1.0, 2.24, 4.0}) {
    const DeviationModel model{.mu = mu};
    const FactorTable table(model, 1e-3);
    for (float x = 0; x < 400; x += 0.37F) {
      for (const int count : {1, 30, 100, 5000}) {
        const double exact = Compare(MeanAndCount{double{x}, 50, 100},
                                     MeanAndCount{0, 50, static_cast<double>(count)}, model)
                                 .p_t;
        EXPECT_NEAR(double{table(SeenAt(x, 100), At(0, count))}, std::max(1e-3, exact), 1e-3);
      }
    }
  }
}

TEST(StepLikelihoodTest, IsSimilarityOverItsMean) {
  const JourneyMap map = LeftMap({{At(100, 40)}, {At(110, 40)}, {At(100, 20)}});
  const auto seen = SeenAt(100, 40);
  const double mean = (1 + Pt(seen, At(110, 40)) + 0.5) / 3;
  const auto likelihoods = Likelihoods(map, {seen});
  ASSERT_EQ(likelihoods.size(), 3u);
  EXPECT_NEAR(double{likelihoods[0]}, 1 / mean, 2e-3);
  EXPECT_NEAR(double{likelihoods[1]}, Pt(seen, At(110, 40)) / mean, 2e-3);
  EXPECT_NEAR(double{likelihoods[2]}, 0.5 / mean, 2e-3);
}

TEST(StepLikelihoodTest, NoSimilarityIsTheFloor) {
  const JourneyMap map = LeftMap({{At(0, 40)}, {At(300, 40)}});
  const auto likelihoods = Likelihoods(map, {SeenAt(0, 40)});
  EXPECT_NEAR(double{likelihoods[1]}, 1e-3 / (1.001 / 2), 1e-5);
}

TEST(StepLikelihoodTest, StepWithoutFingerprintIsNeutral) {
  const JourneyMap map = LeftMap({{At(100, 40)}, {}, {At(200, 40)}});
  EXPECT_EQ(Likelihoods(map, {SeenAt(100, 40)})[1], 1.0F);
}

TEST(StepLikelihoodTest, NothingSeenIsNeutralEverywhere) {
  const JourneyMap map = LeftMap({{At(100, 40)}, {At(200, 40)}});
  EXPECT_THAT(Likelihoods(map, {}), ::testing::Each(1.0F));
}

TEST(StepLikelihoodTest, LandmarkOfTheOtherSideIsNeutral) {
  const JourneyMap map = LeftMap({{At(100, 40)}, {At(200, 40)}});
  const std::string name = "n";
  const JourneyRef ref{&name, &map};
  StepLikelihood likelihood(kBare);
  likelihood.Compute({&ref, 1}, {std::vector<SeenLandmark>{}, {SeenAt(100, 40)}});
  EXPECT_THAT(likelihood.of(0), ::testing::Each(1.0F));
  EXPECT_EQ(likelihood.OffRoute(), 1);
}

TEST(StepLikelihoodTest, AssignsOneToOneForTheGreatestProduct) {
  const SeenLandmark a = SeenAt(100, 40);
  const SeenLandmark b = SeenAt(120, 40);
  // Stored the other way round; nearest to both is 120.
  const JourneyMap map = LeftMap({{At(120, 40), At(112, 40)}, {At(500, 40), At(600, 40)}});
  const double straight = Pt(a, At(120, 40)) * Pt(b, At(112, 40));
  const double crossed = Pt(a, At(112, 40)) * Pt(b, At(120, 40));
  ASSERT_GT(crossed, straight);
  const double mean_a = (Pt(a, At(112, 40)) + 1e-3) / 2;
  const double mean_b = (Pt(b, At(120, 40)) + 1e-3) / 2;
  const double expected = crossed / (mean_a * mean_b);
  EXPECT_NEAR(double{Likelihoods(map, {a, b})[0]} / expected, 1, 5e-3);
}

TEST(StepLikelihoodTest, MissingLandmarkLeavesTheOther) {
  const SeenLandmark seen = SeenAt(100, 40);
  const JourneyMap with_two = LeftMap({{At(100, 40), At(200, 80)}, {At(300, 40), At(400, 80)}});
  const JourneyMap with_one = LeftMap({{At(100, 40)}, {At(300, 40)}});
  EXPECT_NEAR(double{Likelihoods(with_two, {seen})[0]}, double{Likelihoods(with_one, {seen})[0]},
              2e-2);
}

TEST(StepLikelihoodTest, OneLandmarkMayBeTwoOfTheOther) {
  const JourneyMap map = LeftMap({{At(80, 30), At(120, 10)}, {At(300, 40)}});
  // Their mean, by count: (80 * 30 + 120 * 10) / 40 = 90.
  EXPECT_NEAR(double{Likelihoods(map, {SeenAt(90, 40)})[0]}, 2 / 1.001, 1e-2);
  const JourneyMap divided = LeftMap({{At(90, 40)}, {At(300, 40)}});
  EXPECT_NEAR(double{Likelihoods(divided, {SeenAt(80, 30), SeenAt(120, 10)})[0]}, 2 / 1.001, 1e-2);
}

TEST(StepLikelihoodTest, OutliersBoundTheEvidenceAgainst) {
  const JourneyMap map = LeftMap({{At(0, 40)}, {At(300, 40)}});
  LikelihoodOptions options = kBare;
  options.outlier_share = 0.25;
  EXPECT_NEAR(double{Likelihoods(map, {SeenAt(0, 40)}, options)[1]}, 0.25 + 0.75 * 0.002, 1e-4);
  options.temper = 0.5;
  EXPECT_NEAR(double{Likelihoods(map, {SeenAt(0, 40)}, options)[1]}, std::sqrt(0.25 + 0.75 * 0.002),
              1e-4);
}

TEST(StepLikelihoodTest, OffRouteLiesBetweenARandomAndTheTrueStep) {
  const JourneyMap map = LeftMap({{At(0, 40)}, {At(300, 40)}});
  const std::string name = "n";
  const JourneyRef ref{&name, &map};
  for (const double share : {0.0, 0.5, 1.0}) {
    LikelihoodOptions options = kBare;
    options.off_route_share = share;
    StepLikelihood likelihood(options);
    likelihood.Compute({&ref, 1}, {std::vector<SeenLandmark>{SeenAt(0, 40)}, {}});
    // Factors 2 and 0: the true step has 2 on average.
    EXPECT_NEAR(likelihood.OffRoute(), std::pow(2, share), 5e-3);
  }
}

TEST(StepLikelihoodTest, SeveralJourneysShareTheirMean) {
  const JourneyMap near = LeftMap({{At(100, 40)}});
  const JourneyMap far = LeftMap({{At(400, 40)}});
  const std::string name = "n";
  const std::vector<JourneyRef> refs{{&name, &near}, {&name, &far}};
  StepLikelihood likelihood(kBare);
  likelihood.Compute(refs, {std::vector<SeenLandmark>{SeenAt(100, 40)}, {}});
  EXPECT_NEAR(double{likelihood.of(0)[0]}, 2 / 1.001, 1e-3);
  EXPECT_NEAR(double{likelihood.of(1)[0]}, 0.002 / 1.001, 1e-4);
}

}  // namespace
}  // namespace homing
