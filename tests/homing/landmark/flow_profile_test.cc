#include "homing/landmark/flow_profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <vector>

namespace homing {
namespace {

// A vector of `length` along x about the midpoint (x, y).
FlowVector VectorAt(float x, float y, float length) {
  return {x - length / 2, y, x + length / 2, y};
}

FlowField FieldOf(std::vector<FlowVector> vectors) {
  return {.width = 240, .height = 160, .vectors = std::move(vectors)};
}

int CellAt(int column, int row) { return row * FlowProfile::kColumns + column; }

TEST(FlowProfileTest, NothingSeenIsAllZero) {
  EXPECT_EQ(MakeFlowProfile(FieldOf({})), FlowProfile{});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(MakeFlowProfile(FieldOf({{nan, 1, 2, 3}, VectorAt(-20, 5, 2)})), FlowProfile{});
}

// Of `vectors` in a cell of an image with `all`.
int ShareCode(int vectors, int all) {
  return static_cast<int>(std::lround(30 * std::sqrt(vectors / std::sqrt(180.0 * all))));
}

TEST(FlowProfileTest, KeepsTheRootOfEachCellsShare) {
  // One in one cell, three in another.
  const FlowProfile profile = MakeFlowProfile(FieldOf(
      {VectorAt(30, 50, 2), VectorAt(130, 90, 2), VectorAt(131, 91, 2), VectorAt(132, 92, 2)}));
  EXPECT_EQ(profile.share(CellAt(1, 2)), ShareCode(1, 4));
  EXPECT_EQ(profile.share(CellAt(6, 4)), ShareCode(3, 4));
  FlowField field = FieldOf({});
  for (int i = 0; i < 96; ++i) {
    field.vectors.push_back(VectorAt(10 + 20.0F * static_cast<float>(i % 12),
                                     10 + 20.0F * static_cast<float>(i / 12), 2));
  }
  const FlowProfile even = MakeFlowProfile(field);
  for (int cell = 0; cell < FlowProfile::kCells; ++cell) {
    EXPECT_EQ(even.share(cell), ShareCode(1, 96)) << cell;
    EXPECT_EQ(even.parallax(cell), FlowProfile::kMedianParallax) << cell;
  }
}

TEST(FlowProfileTest, ManyVectorsInACellAreAtMostTheGreatestCode) {
  std::vector<FlowVector> vectors(500, VectorAt(30, 50, 2));
  EXPECT_EQ(MakeFlowProfile(FieldOf(std::move(vectors))).share(CellAt(1, 2)), 15);
}

TEST(FlowProfileTest, ParallaxIsRelativeToTheMedianSoThatSpeedCancels) {
  const auto at_speed = [](float speed) {
    return MakeFlowProfile(FieldOf({VectorAt(30, 50, speed), VectorAt(90, 50, speed),
                                    VectorAt(130, 90, 2 * speed), VectorAt(170, 90, speed / 2)}));
  };
  const FlowProfile profile = at_speed(3);
  EXPECT_EQ(profile.parallax(CellAt(1, 2)), 8);
  EXPECT_EQ(profile.parallax(CellAt(6, 4)), 12);
  EXPECT_EQ(profile.parallax(CellAt(8, 4)), 4);
  EXPECT_EQ(at_speed(4.5F), profile);
}

TEST(FlowProfileTest, MagnificationMovesMidpointsFromTheMiddle) {
  const FlowField field = FieldOf({VectorAt(149.5F, 79.5F, 2), VectorAt(229, 79.5F, 2)});
  EXPECT_NE(MakeFlowProfile(field).cells[static_cast<std::size_t>(CellAt(7, 4))], 0);
  const FlowProfile twice = ProfileMaker(field).Make(2);
  // 30 px from the middle become 60; what was at the edge has left the image.
  EXPECT_EQ(twice.share(CellAt(9, 4)), ShareCode(1, 1));
  int filled = 0;
  for (const auto cell : twice.cells) filled += cell != 0 ? 1 : 0;
  EXPECT_EQ(filled, 1);
}

double MiddleOf(std::vector<double> lengths) {
  std::ranges::sort(lengths);
  return lengths[lengths.size() / 2];
}

// Parallax by sorting the lengths of each cell.
TEST(FlowProfileTest, ParallaxIsWhatSortingGivesHoweverTheLengthsLie) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> x(0, 239);
  std::uniform_real_distribution<float> y(0, 159);
  std::lognormal_distribution<float> spread(1, 1);
  std::uniform_int_distribution<int> few(1, 3);
  std::uniform_int_distribution<int> size(1, 700);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<FlowVector> vectors;
    // Some are more than are ranked by counting.
    const int count = trial < 290 ? size(random) : 900 + 40 * (trial - 290);
    for (int i = count; i > 0; --i) {
      // Spread out; a few equal ones; nearly equal, and one that is far longer.
      const float length = trial % 3 == 0   ? spread(random)
                           : trial % 3 == 1 ? static_cast<float>(few(random))
                                            : (i == 1 ? 1e5F : 2 + 1e-6F * spread(random));
      vectors.push_back(VectorAt(x(random), y(random), length));
    }
    std::vector<double> all;
    std::map<int, std::vector<double>> cells;
    for (const FlowVector& v : vectors) {
      // The middle of the image is half a pixel off.
      const double across = (v.MidX() + 0.5) / 240;
      const double down = (v.MidY() + 0.5) / 160;
      all.push_back(v.Length());
      cells[CellAt(static_cast<int>(across * FlowProfile::kColumns),
                   static_cast<int>(down * FlowProfile::kRows))]
          .push_back(v.Length());
    }
    const FlowProfile profile = MakeFlowProfile(FieldOf(vectors));
    const double middle = MiddleOf(all);
    for (const auto& [cell, lengths] : cells) {
      const double octaves = std::log2(MiddleOf(lengths) / middle);
      const long code =
          FlowProfile::kMedianParallax + std::lround(FlowProfile::kParallaxPerOctave * octaves);
      EXPECT_EQ(profile.parallax(cell), std::clamp<long>(code, 1, 15)) << trial << ", " << cell;
    }
  }
}

}  // namespace
}  // namespace homing
