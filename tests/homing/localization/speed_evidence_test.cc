#include "homing/localization/speed_evidence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace homing {
namespace {

TEST(SpeedEvidenceTest, TheMeasuredRatioIsTheLikeliestSpeed) {
  for (const double noise : {0.0, 0.05, 0.3}) {
    const SpeedEvidence evidence(noise);
    for (std::size_t speed = 1; speed < kSpeedCount; ++speed) {
      const auto ratio =
          SpeedEvidence::IndexOf(static_cast<int>(std::lround(20 * std::log2(kSpeeds[speed]))));
      for (std::size_t other = 1; other < kSpeedCount; ++other) {
        EXPECT_GE(evidence.of(speed)[ratio], evidence.of(other)[ratio]) << speed << ", " << other;
      }
    }
  }
}

// A robot of an in-between speed, as 5 frames a second against 30, was believed to stand where the
// map has more flow.
TEST(SpeedEvidenceTest, ARatioBetweenTwoSpeedsCountsAsMuchAsStanding) {
  const SpeedEvidence evidence(0.01);
  const auto between = SpeedEvidence::IndexOf(static_cast<int>(std::lround(20 * -2.75)));
  const auto standing = SpeedEvidence::IndexOf(-20 * 5);
  const float best = std::max(evidence.of(1)[between], evidence.of(2)[between]);
  EXPECT_GE(best, 0.95F * evidence.of(0)[standing]);
}

TEST(SpeedEvidenceTest, NoRatioIsNeutralAndEveryValueIsPositive) {
  const SpeedEvidence evidence(0.1);
  for (std::size_t speed = 0; speed < kSpeedCount; ++speed) {
    EXPECT_EQ(evidence.of(speed)[SpeedEvidence::kNoRatio], 1);
    for (int index = 0; index < SpeedEvidence::kNoRatio; ++index) {
      EXPECT_GT(evidence.of(speed)[index], 0);
    }
  }
}

TEST(SpeedEvidenceTest, ADifferenceOutOfRangeIsTheMostExtreme) {
  EXPECT_EQ(SpeedEvidence::IndexOf(-100000), 0);
  EXPECT_EQ(SpeedEvidence::IndexOf(0), SpeedEvidence::kMostCode);
  EXPECT_EQ(SpeedEvidence::IndexOf(100000), 2 * SpeedEvidence::kMostCode);
}

TEST(SpeedEvidenceTest, SpeedsChangeMoreByAGoodOdometer) {
  EXPECT_GT(SpeedEvidence(0).change(), 0.2);
  EXPECT_LT(SpeedEvidence(1).change(), 0.1);
}

}  // namespace
}  // namespace homing
