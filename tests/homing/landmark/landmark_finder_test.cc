#include "homing/landmark/landmark_finder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <opencv2/core.hpp>

namespace homing {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

// A vector of the given midpoint and flow.
FlowVector Vector(double x, double y, double u = 3, double v = 0) {
  return {static_cast<float>(x - u / 2), static_cast<float>(y - v / 2),
          static_cast<float>(x + u / 2), static_cast<float>(y + v / 2)};
}

// `count` vectors with midpoints evenly over [low, high], adds them to the field.
void AddCluster(FlowField& field, double low, double high, int count, double y = 120,
                double u = 3) {
  for (int i = 0; i < count; ++i) {
    field.vectors.push_back(Vector(low + (high - low) * (i + 0.5) / count, y, u));
  }
}

FlowField EmptyField() { return {320, 240, {}}; }

// Equations 11, 12: x = (100 + 110 + 130 + 120) / 4 = 115, y = (50 + 60 + 70 + 100) / 4 = 70; the
// flow is (3 + 3 + 5 + 5) / 4 = 4, its deviation 1, so the spread 1 / 4.
TEST(FindLandmarksTest, MeanOfTheMidpointsAgreesWithHandComputation) {
  LandmarkOptions options;
  options.min_vectors = 4;
  const FlowField field{
      320, 240, {Vector(100, 50), Vector(110, 60), Vector(130, 70, 5), Vector(120, 100, 5)}};
  const auto seen = FindLandmarks(field, options);
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_FLOAT_EQ(seen[0].x, 115);
  EXPECT_FLOAT_EQ(seen[0].y, 70);
  EXPECT_EQ(seen[0].count, 4);
  EXPECT_DOUBLE_EQ(seen[0].flow_x, 4);
  EXPECT_DOUBLE_EQ(seen[0].flow_y, 0);
  EXPECT_DOUBLE_EQ(seen[0].spread, 0.25);
}

TEST(FindLandmarksTest, MidpointIsTheMeanOfBothEnds) {
  LandmarkOptions options;
  options.min_vectors = 1;
  const auto seen = FindLandmarks({320, 240, {{10, 20, 30, 60}}}, options);
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_FLOAT_EQ(seen[0].x, 20);
  EXPECT_FLOAT_EQ(seen[0].y, 40);
}

// Fig. 4.
TEST(FindLandmarksTest, TheLowestBinBetweenTwoPeaksDividesTwoLandmarks) {
  FlowField field = EmptyField();
  AddCluster(field, 200, 300, 60, 80);
  AddCluster(field, 40, 120, 40, 150);
  const auto seen = FindLandmarks(field, {});
  ASSERT_EQ(seen.size(), 2U);
  EXPECT_NEAR(seen[0].x, 80, 0.01);
  EXPECT_EQ(seen[0].count, 40);
  EXPECT_NEAR(seen[1].x, 250, 0.01);
  EXPECT_EQ(seen[1].count, 60);
  const LandmarkSplit split = SplitAtValley(field, {});
  EXPECT_GT(split.valley_x.value(), 120);
  EXPECT_LT(split.valley_x.value(), 200);
  EXPECT_EQ(std::accumulate(split.histogram.begin(), split.histogram.end(), 0), 100);
}

TEST(FindLandmarksTest, OnePeakIsOneLandmark) {
  FlowField field = EmptyField();
  AddCluster(field, 20, 300, 50);
  AddCluster(field, 130, 190, 60);
  EXPECT_EQ(FindLandmarks(field, {}).size(), 1U);
}

TEST(FindLandmarksTest, AShallowValleyIsOneLandmark) {
  FlowField field = EmptyField();
  AddCluster(field, 40, 140, 60);
  AddCluster(field, 140, 180, 18);
  AddCluster(field, 180, 280, 60);
  EXPECT_EQ(FindLandmarks(field, {}).size(), 1U);
}

TEST(FindLandmarksTest, AFewVectorsApartAreNoLandmarkOfTheirOwn) {
  FlowField field = EmptyField();
  AddCluster(field, 40, 140, 90);
  AddCluster(field, 250, 290, 10);
  const auto seen = FindLandmarks(field, {});
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].count, 100);
}

TEST(FindLandmarksTest, ThreeClustersAreTwoLandmarksAtMost) {
  FlowField field = EmptyField();
  AddCluster(field, 10, 60, 30);
  AddCluster(field, 130, 190, 30);
  AddCluster(field, 260, 310, 30);
  const auto seen = FindLandmarks(field, {});
  ASSERT_EQ(seen.size(), 2U);
  EXPECT_EQ(seen[0].count + seen[1].count, 90);
}

TEST(FindLandmarksTest, ShortVectorsAreOutliers) {
  FlowField field = EmptyField();
  AddCluster(field, 40, 140, 20);
  AddCluster(field, 200, 300, 200, 120, 0.3);
  const auto seen = FindLandmarks(field, {});
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].count, 20);
}

TEST(FindLandmarksTest, NonFiniteVectorsAreOutliers) {
  FlowField field = EmptyField();
  AddCluster(field, 40, 140, 20);
  field.vectors.push_back({std::nanf(""), 1, 5, 1});
  field.vectors.push_back({1, 1, std::numeric_limits<float>::infinity(), 1});
  EXPECT_EQ(FindLandmarks(field, {})[0].count, 20);
  const LandmarkSplit split = SplitAtValley(field, {});
  EXPECT_EQ(split.assignment[20], -1);
  EXPECT_EQ(split.assignment[21], -1);
}

TEST(FindLandmarksTest, NothingSeenIsNoLandmark) {
  EXPECT_THAT(FindLandmarks(EmptyField(), {}), IsEmpty());
  EXPECT_THAT(FindLandmarks({}, {}), IsEmpty());
  EXPECT_THAT(SplitAtValley(EmptyField(), {}).histogram, Each(0));
}

TEST(FindLandmarksTest, FewerThanTheLeastNumberAreNoLandmark) {
  FlowField field = EmptyField();
  AddCluster(field, 40, 140, 7);
  EXPECT_THAT(FindLandmarks(field, {}), IsEmpty());
}

TEST(SplitAtValleyTest, HistogramCountsMidpointsOverTheWidth) {
  LandmarkOptions options;
  options.histogram_bins = 4;
  const FlowField field{
      320, 240, {Vector(0, 9), Vector(79, 9), Vector(80, 9), Vector(319, 9), Vector(-0.4, 9)}};
  EXPECT_THAT(SplitAtValley(field, options).histogram, ElementsAre(3, 1, 0, 1));
}

// Whatever the field: every usable vector is in one landmark, the low one left of the valley.
TEST(SplitAtValleyTest, AssignsEveryUsableVectorToItsSideOfTheValley) {
  cv::RNG random(9);
  int divided = 0;
  for (int trial = 0; trial < 200; ++trial) {
    FlowField field = EmptyField();
    for (int c = 0; c < 3; ++c) {
      const double center = random.uniform(0.0, 320.0);
      for (int i = 0; i < random.uniform(0, 60); ++i) {
        field.vectors.push_back(Vector(center + random.gaussian(12), 100, random.gaussian(2)));
      }
    }
    const LandmarkSplit split = SplitAtValley(field, {});
    divided += split.valley_x.has_value() ? 1 : 0;
    for (std::size_t i = 0; i < field.vectors.size(); ++i) {
      const FlowVector& v = field.vectors[i];
      const bool high = split.valley_x.has_value() && v.MidX() >= *split.valley_x;
      EXPECT_EQ(split.assignment[i], v.Length() < 0.5 ? -1 : int(high));
    }
  }
  EXPECT_GT(divided, 20);
}

}  // namespace
}  // namespace homing
