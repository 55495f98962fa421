#include "homing/profile/profile_likelihood.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "homing/localization/position_filter.h"
#include "tests/homing/profile/random_field.h"

namespace homing {
namespace {

constexpr int kMapSteps = 60;

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
  for (int i = 0; i < 10; ++i) {
    See(Nearer(fields_[20], 1.35F));
    likelihood_.Learn();
  }
  EXPECT_NEAR(likelihood_.MeanOffset(), 0, 1e-9);
}

// The field that the camera sees after a turn to the left.
FlowField TurnedLeft(FlowField field, double widths) {
  const auto shift = static_cast<float>(widths * field.width);
  for (FlowVector& v : field.vectors) {
    v.start_x += shift;
    v.end_x += shift;
  }
  return field;
}

TEST_F(ProfileLikelihoodTest, OneCameraLearnsTheHeading) {
  predicted_.mass.assign(kMapSteps, 0);
  predicted_.mass[20] = 1;
  for (const double turned : {-0.035, 0.035}) {
    likelihood_ = {};
    const FlowField seen = TurnedLeft(fields_[20], turned);
    const float at_first = See(seen)[20];
    for (int i = 0; i < 10; ++i) {
      See(seen);
      likelihood_.Learn();
    }
    // Evidence is bounded: there is little room above the first.
    EXPECT_GT(See(seen)[20], 1.1F * at_first) << turned;
    EXPECT_NEAR(likelihood_.MeanOffset(), 0, 1e-9);
  }
}

TEST_F(ProfileLikelihoodTest, AnInstantOfOneCameraLeavesTheOffsetOfBoth) {
  const double offset = 0.23;
  likelihood_.StartAtOffset(offset);
  const double before = likelihood_.MeanOffset();
  EXPECT_GT(before, 0.1);
  See(fields_[20]);
  likelihood_.Learn();
  EXPECT_DOUBLE_EQ(likelihood_.MeanOffset(), before);
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

// A scene that changes over several steps: an observation of one camera says little, and what a
// restart gives to each step is never weighed away.
TEST_F(ProfileLikelihoodTest, AKnownPlaceIsHeldByFewSteps) {
  constexpr int kSteps = 800;
  constexpr int kScene = 14;
  const auto field_at = [this](int step) {
    FlowField field = fields_[static_cast<std::size_t>(step / kScene)];
    const FlowField& next = fields_[static_cast<std::size_t>(step / kScene + 1)];
    const std::size_t taken =
        field.vectors.size() * static_cast<std::size_t>(step % kScene) / kScene;
    std::copy_n(next.vectors.begin(), std::min(taken, next.vectors.size()), field.vectors.begin());
    return field;
  };
  JourneyMap map;
  for (int step = 0; step < kSteps; ++step) {
    JourneyStep recorded{
        .step = step, .motion = Motion::kMoving, .fingerprints = {}, .profiles = {}};
    recorded.profiles[0] = MakeFlowProfile(field_at(step));
    ASSERT_TRUE(map.Append(recorded).ok());
  }
  const JourneyRef ref{&name_, &map};
  PositionFilter filter{PositionOptions{}};
  std::size_t held = 0;
  for (int step = 100; step < 200; ++step) {
    SeenProfiles seen;
    seen[0].emplace(field_at(step));
    const Position position = filter.Update({&ref, 1}, Motion::kMoving, {}, seen);
    held = filter.masses()[0].mass.size();
    if (step < 140) continue;
    ASSERT_TRUE(position.step);
    EXPECT_NEAR(static_cast<double>(*position.step), step, 10);
  }
  EXPECT_LT(held, kSteps / 4);
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

// The robot drives beside the path, and one camera sees too little for an instant: only the views
// that were compared can be read.
TEST_F(ProfileLikelihoodTest, ACameraMayComeBack) {
  JourneyMap map;
  for (int step = 0; step < kMapSteps; ++step) {
    JourneyStep recorded{
        .step = step, .motion = Motion::kMoving, .fingerprints = {}, .profiles = {}};
    const auto profile = MakeFlowProfile(fields_[static_cast<std::size_t>(step)]);
    recorded.profiles = {profile, profile};
    ASSERT_TRUE(map.Append(recorded).ok());
  }
  const JourneyRef ref{&name_, &map};
  // Held are the steps about the believed one, so that not all offsets are tried.
  const StepMass held{18, std::vector<float>(5, 0.2F)};
  likelihood_.Grow({&ref, 1});
  std::mt19937_64 engine(3);
  for (int i = 0; i < 40; ++i) {
    SeenProfiles seen;
    seen[0].emplace(Nearer(fields_[20], 1 / 0.65F));
    seen[1].emplace(i % 5 == 4 ? RandomField(engine, 3) : Nearer(fields_[20], 1 / 1.35F));
    likelihood_.Compute({&ref, 1}, seen, {&held, 1}, 1);
    likelihood_.Learn();
    const std::int64_t step = likelihood_.Believed(0, 18, 22).step;
    if (i % 5 != 4) {
      EXPECT_EQ(step, 20) << i;
    }
    EXPECT_TRUE(18 <= step && step <= 22) << i;
  }
}

}  // namespace
}  // namespace homing
