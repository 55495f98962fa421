#include "homing/profile/path_offsets.h"

#include <gtest/gtest.h>

#include <numeric>

namespace homing {
namespace {

constexpr std::int64_t kFiveStretches = 5 * PathOffsets::kStretch;
constexpr std::array<bool, kPathOffsets.size()> kAll = {true, true, true, true, true, true, true};

// What was predicted fits the better, the further left the robot drives.
OffsetValues FitsToTheLeft() { return {0.1, 0.2, 0.3, 0.5, 1, 2, 4}; }

class PathOffsetsTest : public ::testing::Test {
 protected:
  PathOffsetsTest() { offsets_.Grow(kFiveStretches); }

  void LearnLeftAt(std::size_t stretch, int times) {
    const std::array<OffsetValues, 1> fits = {FitsToTheLeft()};
    for (int i = 0; i < times; ++i) {
      offsets_.Learn(stretch, fits, kAll);
    }
  }

  PathOffsets offsets_;
};

TEST_F(PathOffsetsTest, GoesWhereTheRobotGoesAndNowhereElse) {
  LearnLeftAt(1, 10);
  EXPECT_GT(offsets_.of(1)[6], 0.5);
  EXPECT_EQ(offsets_.of(2), offsets_.of(1));
  EXPECT_EQ(offsets_.of(0), offsets_.of(1));
  EXPECT_EQ(offsets_.of(3), PathOffsets::Prior());
  EXPECT_EQ(offsets_.of(4), PathOffsets::Prior());
}

TEST_F(PathOffsetsTest, TakesItsOffsetFromWhereMostOfTheRobotComesFrom) {
  LearnLeftAt(3, 10);
  const OffsetValues left = offsets_.of(3);
  OffsetValues straight{};
  straight[3] = 1e-6;
  OffsetValues alike{};
  alike.fill(1);
  offsets_.Learn(2, std::array<OffsetValues, 2>{straight, alike}, kAll);
  EXPECT_NEAR(offsets_.of(2)[6], left[6], 0.1);
  EXPECT_GT(offsets_.of(1)[3], 0.9);
}

TEST_F(PathOffsetsTest, IsForgottenWhereTheRobotIsNot) {
  LearnLeftAt(1, 10);
  LearnLeftAt(4, 1);
  EXPECT_EQ(offsets_.of(1), PathOffsets::Prior());
  EXPECT_NE(offsets_.of(4), PathOffsets::Prior());
}

TEST_F(PathOffsetsTest, AnOffsetThatWasNotTriedNeitherGainsNorLoses) {
  LearnLeftAt(1, 2);
  const OffsetValues before = offsets_.of(1);
  std::array<bool, kPathOffsets.size()> tried = kAll;
  tried[0] = false;
  OffsetValues alike{};
  alike.fill(1);
  alike[0] = 0;
  offsets_.Learn(1, std::array<OffsetValues, 1>{alike}, tried);
  EXPECT_EQ(offsets_.of(1), PathOffsets::Mix(before));
}

TEST_F(PathOffsetsTest, ReturnsTheMassThatFits) {
  const OffsetValues mass = offsets_.Learn(1, std::array<OffsetValues, 1>{FitsToTheLeft()}, kAll);
  for (std::size_t i = 0; i < mass.size(); ++i) {
    EXPECT_DOUBLE_EQ(mass[i], PathOffsets::Prior()[i] * FitsToTheLeft()[i]);
  }
  EXPECT_NEAR(std::accumulate(PathOffsets::Prior().begin(), PathOffsets::Prior().end(), 0.0), 1,
              1e-12);
}

TEST_F(PathOffsetsTest, NewStretchesKnowNothing) {
  LearnLeftAt(4, 5);
  offsets_.Grow(kFiveStretches + 1);
  EXPECT_EQ(offsets_.of(5), PathOffsets::Prior());
  EXPECT_EQ(PathOffsets::StretchesOf(0), 0);
  EXPECT_EQ(PathOffsets::StretchesOf(PathOffsets::kStretch), 1);
  EXPECT_EQ(PathOffsets::StretchesOf(PathOffsets::kStretch + 1), 2);
}

}  // namespace
}  // namespace homing
