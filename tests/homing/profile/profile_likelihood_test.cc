#include "homing/profile/profile_likelihood.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "homing/localization/position_filter.h"
#include "homing/profile/profile_blocks.h"
#include "homing/profile/profile_evidence.h"

namespace homing {
namespace {

constexpr int kMapSteps = 60;

// A camera's field of `count` vectors at random places, about the middle of the image.
FlowField RandomField(std::mt19937_64& engine, int count = 120) {
  std::uniform_real_distribution<float> x(60, 260);
  std::uniform_real_distribution<float> y(40, 200);
  std::uniform_real_distribution<float> length(2, 6);
  FlowField field{.width = 320, .height = 240, .vectors = {}};
  for (int i = 0; i < count; ++i) {
    const float at = x(engine);
    const float height = y(engine);
    const float half = length(engine) / 2;
    field.vectors.push_back({at - half, height, at + half, height});
  }
  return field;
}

// As seen from nearer, about the middle of the image.
FlowField Nearer(FlowField field, float by) {
  for (FlowVector& v : field.vectors) {
    v = {159.5F + by * (v.start_x - 159.5F), 119.5F + by * (v.start_y - 119.5F),
         159.5F + by * (v.end_x - 159.5F), 119.5F + by * (v.end_y - 119.5F)};
  }
  return field;
}

class ProfileLikelihoodTest : public ::testing::Test {
 protected:
  ProfileLikelihoodTest() {
    std::mt19937_64 engine(7);
    for (int step = 0; step < kMapSteps; ++step) {
      fields_.push_back(RandomField(engine));
      JourneyStep recorded{
          .step = step, .motion = Motion::kMoving, .fingerprints = {}, .profiles = {}};
      recorded.profiles[0] = MakeFlowProfile(fields_.back());
      EXPECT_TRUE(map_.Append(recorded).ok());
    }
  }

  // What it says, before it is taken up.
  std::span<const float> See(const FlowField& field, std::size_t side = 0) {
    SeenProfiles seen;
    seen[side].emplace(field);
    likelihood_.Grow({&ref_, 1});
    likelihood_.Compute({&ref_, 1}, seen, {&predicted_, 1}, 1);
    return likelihood_.of(0);
  }

  std::vector<FlowField> fields_;
  std::string name_ = "robots/a/journeys/b";
  JourneyMap map_;
  JourneyRef ref_{&name_, &map_};
  StepMass predicted_{0, std::vector<float>(kMapSteps, 1.0F / kMapSteps)};
  ProfileLikelihood likelihood_;
};

TEST_F(ProfileLikelihoodTest, TheStepItselfIsTheMostLikely) {
  for (int step = 0; step < kMapSteps; ++step) {
    const auto likelihood = See(fields_[static_cast<std::size_t>(step)]);
    // Evidence is bounded: another step may reach the bound too.
    EXPECT_EQ(std::ranges::max(likelihood), likelihood[static_cast<std::size_t>(step)]);
    EXPECT_EQ(likelihood_.Believed(0, 0, kMapSteps - 1).step, step);
  }
}

TEST_F(ProfileLikelihoodTest, OneCameraLearnsNoOffset) {
  predicted_.mass.assign(kMapSteps, 0);
  predicted_.mass[20] = 1;
  const float at_first = See(Nearer(fields_[20], 1.35F))[20];
  for (int i = 0; i < 10; ++i) {
    See(Nearer(fields_[20], 1.35F));
    likelihood_.Learn();
  }
  EXPECT_FLOAT_EQ(See(Nearer(fields_[20], 1.35F))[20], at_first);
}

TEST_F(ProfileLikelihoodTest, WhatIsLearntAtOnePlaceIsNotExpectedAtAFarOne) {
  predicted_.mass.assign(kMapSteps, 0);
  predicted_.mass[5] = 1;
  See(fields_[5]);
  likelihood_.Learn();
  const float before = See(fields_[50])[50];
  for (int i = 0; i < 10; ++i) {
    See(Nearer(fields_[5], 1.35F));
    likelihood_.Learn();
  }
  EXPECT_FLOAT_EQ(See(fields_[50])[50], before);
}

TEST_F(ProfileLikelihoodTest, TheOffsetGrowsWithTheDistanceToTheLeft) {
  JourneyMap map;
  for (int step = 0; step < kMapSteps; ++step) {
    JourneyStep recorded{
        .step = step, .motion = Motion::kMoving, .fingerprints = {}, .profiles = {}};
    const auto other = static_cast<std::size_t>(kMapSteps - 1 - step);
    recorded.profiles = {MakeFlowProfile(fields_[static_cast<std::size_t>(step)]),
                         MakeFlowProfile(fields_[other])};
    ASSERT_TRUE(map.Append(recorded).ok());
  }
  const JourneyRef ref{&name_, &map};
  predicted_.mass.assign(kMapSteps, 0);
  predicted_.mass[20] = 1;
  double before = -1;
  for (const float offset : {-0.3F, -0.15F, 0.0F, 0.15F, 0.3F}) {
    ProfileLikelihood likelihood;
    likelihood.Grow({&ref, 1});
    for (int i = 0; i < 15; ++i) {
      SeenProfiles seen;
      seen[0].emplace(Nearer(fields_[20], 1 / (1 - offset)));
      seen[1].emplace(Nearer(fields_[kMapSteps - 21], 1 / (1 + offset)));
      likelihood.Compute({&ref, 1}, seen, {&predicted_, 1}, 1);
      likelihood.Learn();
    }
    EXPECT_GT(likelihood.MeanOffset(), before) << offset;
    before = likelihood.MeanOffset();
  }
}

TEST_F(ProfileLikelihoodTest, ARobotThatPassesTheEndIsNoLongerOnTheRoute) {
  std::mt19937_64 engine(12);
  PositionFilter filter{PositionOptions{}};
  const PositionPrior prior{.journey = 0,
                            .step = 20,
                            .direction = Direction::kOutward,
                            .probability = 0.9,
                            .path_offset = {}};
  ASSERT_TRUE(filter.Start({&ref_, 1}, prior).ok());
  Position position;
  for (int step = 21; step < kMapSteps; ++step) {
    SeenProfiles seen;
    seen[0].emplace(fields_[static_cast<std::size_t>(step)]);
    position = filter.Update({&ref_, 1}, Motion::kMoving, {}, seen);
    if (step == 21) {
      EXPECT_NEAR(static_cast<double>(position.step.value_or(-9)), 21, 10);
    }
  }
  EXPECT_EQ(position.outcome, Outcome::kMatch);
  EXPECT_EQ(position.direction, Direction::kOutward);
  for (int i = 0; i < 40; ++i) {
    SeenProfiles seen;
    seen[0].emplace(RandomField(engine));
    position = filter.Update({&ref_, 1}, Motion::kMoving, {}, seen);
  }
  EXPECT_EQ(position.outcome, Outcome::kUnknownPlace);
}

// The odds are bounded: some observations that fit must bring the robot back.
TEST_F(ProfileLikelihoodTest, ALongForeignWayLeavesTheOddsBounded) {
  std::mt19937_64 engine(11);
  PositionFilter filter{PositionOptions{}};
  Position position;
  for (int i = 0; i < 100; ++i) {
    SeenProfiles seen;
    seen[0].emplace(RandomField(engine));
    position = filter.Update({&ref_, 1}, Motion::kMoving, {}, seen);
  }
  EXPECT_EQ(position.outcome, Outcome::kUnknownPlace);
  EXPECT_LT(position.unknown_probability, 0.999);
}

// The belief loses nearly all its mass beyond the ends of a short map, time and again.
TEST_F(ProfileLikelihoodTest, ALongForeignWayOnAShortMapKeepsTheNumbersFinite) {
  JourneyMap map;
  for (int step = 0; step < 15; ++step) {
    JourneyStep recorded{
        .step = step, .motion = Motion::kMoving, .fingerprints = {}, .profiles = {}};
    recorded.profiles[0] = MakeFlowProfile(fields_[static_cast<std::size_t>(step)]);
    ASSERT_TRUE(map.Append(recorded).ok());
  }
  const JourneyRef ref{&name_, &map};
  std::mt19937_64 engine(12);
  PositionFilter filter{PositionOptions{}};
  for (int i = 0; i < 3000; ++i) {
    SeenProfiles seen;
    seen[0].emplace(Nearer(RandomField(engine), i % 2 == 0 ? 8.0F : 6.0F));
    const Position position = filter.Update({&ref, 1}, Motion::kMoving, {}, seen);
    ASSERT_TRUE(std::isfinite(position.unknown_probability)) << i;
    ASSERT_LE(position.probability, 1 - position.unknown_probability + 1e-9) << i;
  }
}

TEST_F(ProfileLikelihoodTest, TheOtherSideSaysNothing) {
  SeenProfiles seen;
  seen[1].emplace(fields_[3]);
  EXPECT_FALSE(ProfileLikelihood::CanCompare({&ref_, 1}, seen));
  EXPECT_FALSE(ProfileLikelihood::CanCompare({&ref_, 1}, {}));
  seen[0] = seen[1];
  EXPECT_TRUE(ProfileLikelihood::CanCompare({&ref_, 1}, seen));
}

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
  for (const std::size_t count : {0, 1, 31, 32, 33, 64, 70}) {
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
