// Corners: their strength against OpenCV's, their distance from one another.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "homing/flow/corner_detector.h"
#include "homing/flow/corner_strength.h"
#include "homing/flow/working_image.h"
#include "tests/homing/flow/flow_pictures.h"

namespace homing {
namespace {

class CornerStrengthTest : public ::testing::TestWithParam<cv::Size> {};

TEST_P(CornerStrengthTest, IsOpenCvsButForItsScale) {
  cv::Mat image(GetParam(), CV_32FC1);
  cv::RNG(5).fill(image, cv::RNG::NORMAL, 0, 1);
  cv::Mat strength;
  CornerStrength(image, &strength);
  cv::Mat expected;
  cv::cornerMinEigenVal(image, expected, kCornerBlockPx, 3, cv::BORDER_REFLECT_101);
  ASSERT_EQ(strength.size(), image.size());
  // OpenCV divides gradients by 4 and by the block's side, not by 8 and the root of its area.
  const float scale = StrengthOf(1) / 4;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      EXPECT_NEAR(strength.at<float>(y, x) / scale, expected.at<float>(y, x), 1e-5)
          << x << ", " << y;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, CornerStrengthTest,
                         ::testing::Values(cv::Size(5, 5), cv::Size(16, 5), cv::Size(5, 16),
                                           cv::Size(33, 40), cv::Size(320, 240)));

TEST(CornerStrengthTest, AnEdgeHasNone) {
  cv::Mat image(20, 20, CV_32FC1, cv::Scalar(0));
  image.colRange(10, 20).setTo(7);
  cv::Mat strength;
  CornerStrength(image, &strength);
  EXPECT_EQ(cv::countNonZero(strength), 0);
}

TEST(DetectCornersTest, EachIsTheStrongestNearIt) {
  const FlowOptions options;
  const cv::Mat image = NormalizedImage(TexturePicture(320, 240, 0, 0), options);
  const auto corners = DetectCorners(image, options);
  ASSERT_GT(corners.size(), 100U);
  cv::Mat strength;
  CornerStrength(image, &strength);
  const int reach = options.cell_px / 2;
  const cv::Rect whole({}, image.size());
  for (const cv::Point2f& corner : corners) {
    const cv::Rect near(static_cast<int>(corner.x) - reach, static_cast<int>(corner.y) - reach,
                        2 * reach + 1, 2 * reach + 1);
    double most = 0;
    cv::minMaxLoc(strength(near & whole), nullptr, &most);
    EXPECT_EQ(strength.at<float>(cv::Point(corner)), static_cast<float>(most));
    EXPECT_GT(most, static_cast<double>(StrengthOf(options.min_eigenvalue)));
  }
}

TEST(DetectCornersTest, OfTooManyTheStrongestAreLeft) {
  FlowOptions options;
  options.cell_px = 4;
  options.min_eigenvalue = 1e-6;
  cv::Mat image(600, 1600, CV_32FC1);
  cv::RNG(5).fill(image, cv::RNG::NORMAL, 0, 1);
  const auto all = DetectCorners(image, options);
  options.window_px = 63;
  const std::size_t most = kMostWindowPixels / (63 * 63);
  ASSERT_GT(all.size(), 2 * most);
  const auto left = DetectCorners(image, options);
  EXPECT_EQ(left.size(), most);
  cv::Mat strength;
  CornerStrength(image, &strength);
  float weakest = strength.at<float>(cv::Point(left.front()));
  for (const cv::Point2f& corner : left) {
    weakest = std::min(weakest, strength.at<float>(cv::Point(corner)));
  }
  std::vector<cv::Point2f> stronger;
  for (const cv::Point2f& corner : all) {
    if (strength.at<float>(cv::Point(corner)) >= weakest) stronger.push_back(corner);
  }
  EXPECT_EQ(left, stronger);
  EXPECT_EQ(DetectCorners(cv::Mat::ones(600, 1600, CV_32FC1), options).size(), 0U);
}

}  // namespace
}  // namespace homing
