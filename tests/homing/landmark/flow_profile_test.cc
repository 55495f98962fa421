#include "homing/landmark/flow_profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
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

// Count codes back to parts of all vectors' weight.
double WeightOf(const FlowProfile& profile) {
  double sum = 0;
  for (int cell = 0; cell < FlowProfile::kCells; ++cell) {
    sum += std::pow(profile.count_code(cell) / FlowProfile::kCountPerRoot, 2);
  }
  return sum;
}

FlowField Even(int columns, int rows, float length) {
  FlowField field = FieldOf({});
  for (int i = 0; i < columns * rows; ++i) {
    field.vectors.push_back(VectorAt(
        (0.5F + static_cast<float>(i % columns)) * 240.0F / static_cast<float>(columns),
        (0.5F + static_cast<float>(i / columns)) * 160.0F / static_cast<float>(rows), length));
  }
  return field;
}

TEST(FlowProfileTest, CellsHoldTheWholeWeightOfTheVectors) {
  // sqrt(n / 180) is the sum of the shares; a code is rounded by up to half, here to 2 and to 3.
  EXPECT_NEAR(WeightOf(MakeFlowProfile(Even(16, 10, 2))), std::sqrt(160 / 180.0), 0.25);
  EXPECT_NEAR(WeightOf(MakeFlowProfile(Even(32, 20, 2))), std::sqrt(640 / 180.0), 0.35);
}

TEST(FlowProfileTest, AVectorThatCrossesACellBorderChangesCodesByLittle) {
  FlowField field = Even(16, 10, 2);
  const float border = 240.0F * 5 / 16;
  const auto with = [&field](float x) {
    FlowField moved = field;
    moved.vectors.push_back(VectorAt(x, 55, 2));
    return MakeFlowProfile(moved);
  };
  const FlowProfile left = with(border - 0.6F);
  const FlowProfile right = with(border + 0.4F);
  for (int cell = 0; cell < FlowProfile::kCells; ++cell) {
    EXPECT_NEAR(left.count_code(cell), right.count_code(cell), 1) << cell;
    EXPECT_EQ(left.parallax_code(cell), right.parallax_code(cell)) << cell;
  }
}

TEST(FlowProfileTest, ManyVectorsInACellAreAtMostTheGreatestCode) {
  const FlowProfile profile =
      MakeFlowProfile(FieldOf(std::vector<FlowVector>(500, VectorAt(37, 55.5F, 2))));
  EXPECT_EQ(profile.count_code(CellAt(2, 3)), FlowProfile::kMaxCode);
}

TEST(FlowProfileTest, ParallaxIsRelativeToTheMeanSoThatSpeedCancels) {
  const auto at_speed = [](float speed) {
    FlowField field = Even(16, 10, speed);
    for (FlowVector& v : field.vectors) {
      if (v.MidX() > 200)
        v = VectorAt(static_cast<float>(v.MidX()), static_cast<float>(v.MidY()), 2 * speed);
    }
    return MakeFlowProfile(field);
  };
  const FlowProfile slow = at_speed(3);
  const FlowProfile fast = at_speed(4.5F);
  EXPECT_EQ(slow.cells, fast.cells);
  EXPECT_NEAR(slow.parallax_code(CellAt(15, 4)) - slow.parallax_code(CellAt(2, 4)), 4, 1);
  EXPECT_NE(slow.odometer, fast.odometer);
}

TEST(FlowProfileTest, MagnificationMovesMidpointsFromTheMiddle) {
  const FlowField field = FieldOf({VectorAt(149.5F, 79.5F, 2), VectorAt(229, 79.5F, 2)});
  const FlowProfile twice = ProfileMaker(field).Make(2);
  // 30 px from the middle become 60; what was at the edge has left the image.
  EXPECT_GT(twice.count_code(CellAt(11, 4)) + twice.count_code(CellAt(12, 4)), 0);
  EXPECT_EQ(twice.count_code(CellAt(9, 4)), 0);
  EXPECT_EQ(twice.count_code(CellAt(15, 4)), 0);
}

TEST(FlowProfileTest, AShiftMovesTheImageToTheRight) {
  const FlowField field = FieldOf({VectorAt(52.5F, 72, 2), VectorAt(236, 72, 2)});
  const FlowProfile shifted = ProfileMaker(field).Make(1, 2.0 / FlowProfile::kColumns);
  EXPECT_GT(shifted.count_code(CellAt(5, 4)), 0);
  EXPECT_EQ(shifted.count_code(CellAt(3, 4)), 0);
  // The other vector has left the image.
  for (int row = 0; row < FlowProfile::kRows; ++row) {
    EXPECT_EQ(shifted.count_code(CellAt(15, row)), 0);
  }
}

// The codes as the header states them, one vector after another.
std::vector<double> PlainCounts(const FlowField& field) {
  std::vector<double> weights(FlowProfile::kCells);
  for (const FlowVector& v : field.vectors) {
    const double x = (v.MidX() + 0.5) / field.width * FlowProfile::kColumns - 0.5;
    const double y = (v.MidY() + 0.5) / field.height * FlowProfile::kRows - 0.5;
    for (const int column : {0, 1}) {
      for (const int row : {0, 1}) {
        const double left = std::floor(x), top = std::floor(y);
        const double weight =
            (column == 0 ? 1 - (x - left) : x - left) * (row == 0 ? 1 - (y - top) : y - top);
        const int c = std::clamp(static_cast<int>(left) + column, 0, FlowProfile::kColumns - 1);
        const int r = std::clamp(static_cast<int>(top) + row, 0, FlowProfile::kRows - 1);
        weights[static_cast<std::size_t>(CellAt(c, r))] += weight;
      }
    }
  }
  const double usual =
      std::sqrt(static_cast<double>(field.vectors.size()) * FlowProfile::kUsualCount);
  for (double& weight : weights) {
    weight = std::min<double>(FlowProfile::kCountPerRoot * std::sqrt(weight / usual),
                              FlowProfile::kMaxCode);
  }
  return weights;
}

TEST(FlowProfileTest, IsAsThePlainReference) {
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<float> x(0, 239), y(0, 159), length(0.5F, 20);
  for (int round = 0; round < 20; ++round) {
    FlowField field = FieldOf({});
    for (int i = 0; i < 20 + 20 * round; ++i) {
      field.vectors.push_back(VectorAt(x(engine), y(engine), length(engine)));
    }
    const FlowProfile profile = MakeFlowProfile(field);
    const std::vector<double> plain = PlainCounts(field);
    for (int cell = 0; cell < FlowProfile::kCells; ++cell) {
      EXPECT_NEAR(profile.count_code(cell), plain[static_cast<std::size_t>(cell)], 0.501) << cell;
    }
  }
}

}  // namespace
}  // namespace homing
