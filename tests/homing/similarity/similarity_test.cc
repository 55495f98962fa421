#include "homing/similarity/similarity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace homing {
namespace {

std::vector<std::vector<double>> GoldenRows() {
  std::ifstream file(HOMING_SOURCE_DIR "/tests/golden/similarity.csv");
  std::vector<std::vector<double>> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream fields(line);
    std::vector<double> row;
    for (std::string field; std::getline(fields, field, ',');) {
      row.push_back(std::stod(field));
    }
    rows.push_back(row);
  }
  return rows;
}

void ExpectClose(double actual, double expected) {
  EXPECT_LE(std::fabs(actual - expected), 1e-12 * std::fabs(expected)) << actual << " " << expected;
}

TEST(SimilarityTest, AgreesWithFortyDigitArithmetic) {
  const auto rows = GoldenRows();
  ASSERT_EQ(rows.size(), 64u);
  for (const auto& row : rows) {
    ASSERT_EQ(row.size(), 11u);
    const Similarity s =
        Compare(MeanAndCount{row[0], row[1], row[2]}, MeanAndCount{row[3], row[4], row[5]},
                DeviationModel{.mu = row[6], .sigma = row[7]});
    ExpectClose(s.delta, row[8]);
    ExpectClose(s.p, row[9]);
    ExpectClose(s.p_t, row[10]);
  }
}

// Equations (13) to (15): a 3-4-5 triangle; ln 5 = 1.609437912434; z = -0.73321; Phi(-z) = 0.76828.
TEST(SimilarityTest, MultipliesProbabilityAndRatioOfNumbers) {
  const Similarity s = Compare(MeanAndCount{10, 20, 30}, MeanAndCount{13, 24, 40}, {});
  EXPECT_DOUBLE_EQ(s.delta, 5);
  EXPECT_NEAR(s.p, 0.76828, 2e-5);
  EXPECT_NEAR(s.p_t, 0.75 * 0.76828, 2e-5);
}

TEST(SimilarityTest, SamePlaceHasProbabilityOne) {
  const Similarity s = Compare(MeanAndCount{10, 20, 30}, MeanAndCount{10, 20, 60}, {});
  EXPECT_EQ(s.delta, 0);
  EXPECT_EQ(s.p, 1);
  EXPECT_EQ(s.p_t, 0.5);
}

TEST(SimilarityTest, NoVectorsOnEitherSideIsNoSimilarity) {
  EXPECT_EQ(Compare(MeanAndCount{10, 20, 0}, MeanAndCount{10, 20, 60}, {}).p_t, 0);
  EXPECT_EQ(Compare(MeanAndCount{10, 20, 60}, MeanAndCount{10, 20, 0}, {}).p_t, 0);
  EXPECT_EQ(Compare(MeanAndCount{10, 20, 0}, MeanAndCount{10, 20, 0}, {}).p_t, 0);
}

TEST(SimilarityTest, IsTheSameBothWays) {
  const MeanAndCount i{10.5, 20.25, 17};
  const MeanAndCount j{99, 3, 23};
  EXPECT_EQ(Compare(i, j, {}).p_t, Compare(j, i, {}).p_t);
}

TEST(SimilarityTest, OfStoredFingerprintsIsThatOfTheirValues) {
  const Fingerprint i{.x = 10.5F, .y = 20.25F, .count = 17};
  const Fingerprint j{.x = 99, .y = 3, .count = 23};
  EXPECT_EQ(Compare(i, j, {}).p_t,
            Compare(MeanAndCount{10.5, 20.25, 17}, MeanAndCount{99, 3, 23}, {}).p_t);
}

}  // namespace
}  // namespace homing
