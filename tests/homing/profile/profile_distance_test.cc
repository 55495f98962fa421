#include "homing/profile/profile_distance.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <random>

#include "homing/profile/profile_blocks.h"
#include "homing/profile/profile_evidence.h"
#include "homing/profile/profile_likelihood.h"
#include "tests/homing/profile/random_field.h"

namespace homing {
namespace {

TEST(ProfileDistanceTest, IsZeroToItselfAndNearlySymmetric) {
  std::mt19937_64 engine(9);
  const FlowProfile a = MakeFlowProfile(RandomField(engine));
  const FlowProfile b = MakeFlowProfile(RandomField(engine));
  const CellMask all = CoveredCells(1);
  std::vector<std::uint16_t> from_a(2);
  std::vector<std::uint16_t> from_b(2);
  const std::vector<FlowProfile> stored = {a, b};
  ProfileDistances(a, stored, all, from_a);
  ProfileDistances(b, stored, all, from_b);
  EXPECT_EQ(from_a[0], 0);
  EXPECT_EQ(from_b[1], 0);
  // What is gone counts three quarters of what has come.
  EXPECT_GT(from_a[1], 0);
  EXPECT_GE(from_a[1], from_b[0] * 3 / 4);
  EXPECT_LE(from_a[1], from_b[0] * 4 / 3);
}

TEST(ProfileDistanceTest, CountsSharesAndParallaxOfCoveredCells) {
  FlowProfile a;
  FlowProfile b;
  a.cells[0] = 8 << 4 | 5;  // A corner: not covered by half the image.
  b.cells[0] = 10 << 4 | 2;
  a.cells[53] = 15 << 4 | 4;
  b.cells[53] = 1 << 4 | 9;
  a.cells[54] = 7 << 4 | 3;  // Nothing there in b: no parallax to compare.
  const std::vector<FlowProfile> stored = {b};
  std::vector<std::uint16_t> distance(1);
  ProfileDistances(a, stored, CoveredCells(1), distance);
  EXPECT_EQ(distance[0], (4 * 3 + 2) + (3 * 5 + 6) + 4 * 3);
  ProfileDistances(a, stored, CoveredCells(0.5), distance);
  EXPECT_EQ(distance[0], (3 * 5 + 6) + 4 * 3);
}

// Codes of all kinds, many of them none.
FlowProfile RandomCodes(std::mt19937_64& engine) {
  std::uniform_int_distribution<int> code(-15, FlowProfile::kMaxCode);
  FlowProfile profile;
  for (std::uint8_t& cell : profile.cells) {
    cell = static_cast<std::uint8_t>(std::max(0, code(engine)) << 4 | std::max(0, code(engine)));
  }
  return profile;
}

TEST(ProfileDistanceTest, IsTheSameByBlocksAsCellByCell) {
  if (!ProfileBlocksFit()) GTEST_SKIP() << "SKIPPED: this machine has no AVX2";
  std::mt19937_64 engine(10);
  std::vector<FlowProfile> all;
  for (int i = 0; i < 70; ++i) all.push_back(RandomCodes(engine));
  all[3].cells.fill(0xff);
  all[4].cells.fill(0);
  // Whole blocks, parts of one, and none.
  for (const std::size_t count : {0u, 1u, 31u, 32u, 33u, 64u, 70u}) {
    const auto stored = std::span(all).first(count);
    for (const double magnification : {0.1, 0.65, 1.0, 1.35}) {
      const CellMask covered = CoveredCells(magnification);
      const std::array seen = {RandomCodes(engine), all[3], all[4]};
      std::array<std::vector<std::uint16_t>, 3> by_blocks;
      std::vector<ProfileView> views;
      for (std::size_t i = 0; i < seen.size(); ++i) {
        by_blocks[i].resize(count);
        views.push_back({seen[i], covered, by_blocks[i]});
      }
      ProfileDistancesByBlocks(views, stored);
      for (std::size_t i = 0; i < seen.size(); ++i) {
        std::vector<std::uint16_t> plain(count);
        PlainProfileDistances({seen[i], covered, plain}, stored);
        std::vector<const FlowProfile*> listed;
        for (const FlowProfile& profile : stored) listed.push_back(&profile);
        std::vector<std::uint16_t> of_list(count);
        const ProfileView view{seen[i], covered, of_list};
        ProfileDistances({&view, 1}, listed);
        EXPECT_EQ(of_list, plain) << count << " listed";
        EXPECT_EQ(by_blocks[i], plain) << count << " stored, view " << i << " x" << magnification;
      }
    }
  }
}

TEST(ProfileRatioTest, MultipliesAsOneByOne) {
  std::vector<std::uint16_t> distances;
  for (int distance = 0; distance <= 6336; distance += 7) {
    distances.push_back(static_cast<std::uint16_t>(distance));
  }
  // The narrow one reaches beyond both ends of the ratios.
  for (const DistanceScale scale : {DistanceScale{600, 0.01F}, DistanceScale{900, 1.5F}}) {
    std::vector<float> factors(distances.size(), 0.5F);
    const std::vector<std::int16_t> bias(distances.size(), 0);
    const ProfileRatio& ratio = ProfileRatio::OfWeight(1);
    ratio.Multiply(distances, bias, scale, factors);
    for (std::size_t i = 0; i < distances.size(); ++i) {
      ASSERT_EQ(factors[i], 0.5F * ratio(scale.Deviations(distances[i]))) << distances[i];
    }
    EXPECT_GT(factors.front(), factors.back());
  }
}

}  // namespace
}  // namespace homing
