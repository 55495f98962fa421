// The number of vectors is half of a fingerprint: it must not depend on light.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "homing/flow/corner_detector.h"
#include "homing/flow/working_image.h"
#include "tests/homing/flow/flow_pictures.h"
#include "tests/support/real_sequences.h"

namespace homing {
namespace {

struct MeanAndNumber {
  double x = 0;
  double y = 0;
  double number = 0;
};

MeanAndNumber Summary(const FlowField& field) {
  MeanAndNumber sum;
  sum.number = static_cast<double>(field.vectors.size());
  for (const FlowVector& v : field.vectors) {
    sum.x += v.MidX() / sum.number;
    sum.y += v.MidY() / sum.number;
  }
  return sum;
}

struct Light {
  int width;
  double gain;
  double noise;
};

class LightTest : public ::testing::TestWithParam<Light> {};

TEST_P(LightTest, NumberAndMeanOfTheVectorsStay) {
  const auto [width, gain, noise] = GetParam();
  const int height = width * 3 / 4;
  const double zoom = width / 320.0;
  const cv::Mat before = 0.75 * TexturePicture(width, height, 0, 0, zoom);
  const cv::Mat now = 0.75 * TexturePicture(width, height, 2, 0, zoom);
  const MeanAndNumber reference = Summary(FlowOf(Exposed(before, 1, 2, 1), Exposed(now, 1, 2, 2)));
  const MeanAndNumber other =
      Summary(FlowOf(Exposed(before, gain, noise, 3), Exposed(now, gain, noise, 4)));
  ASSERT_GT(reference.number, 50);
  EXPECT_NEAR(other.number / reference.number, 1, 0.15);
  EXPECT_LT(std::hypot(other.x - reference.x, other.y - reference.y), 0.03 * width);
}

INSTANTIATE_TEST_SUITE_P(GainsAndNoise, LightTest,
                         ::testing::Values(Light{160, 0.6, 2}, Light{160, 1.5, 2}, Light{160, 1, 4},
                                           Light{320, 0.6, 2}, Light{320, 1.5, 2},
                                           Light{320, 0.6, 4}, Light{640, 0.6, 2},
                                           Light{640, 1.5, 4}));

TEST(LightTest, ABrightSignChangesNothingElsewhere) {
  const FlowOptions options;
  const cv::Mat plain = TexturePicture(320, 240, 0, 0);
  cv::Mat with_sign = plain.clone();
  cv::rectangle(with_sign, {20, 20, 24, 24}, cv::Scalar(255), cv::FILLED);
  cv::rectangle(with_sign, {26, 26, 12, 12}, cv::Scalar(0), cv::FILLED);
  const auto far_corners = [&options](const cv::Mat& image) {
    std::vector<cv::Point2f> corners = DetectCorners(NormalizedImage(image, options), options);
    std::erase_if(corners, [](const cv::Point2f& p) { return p.x < 90 && p.y < 90; });
    return corners;
  };
  ASSERT_GT(far_corners(plain).size(), 50U);
  EXPECT_EQ(far_corners(with_sign), far_corners(plain));
}

// Of 1200 cells, three in a hundred.
TEST(LightTest, NoiseOnABlankWallMakesHardlyAnyVector) {
  const cv::Mat wall(240, 320, CV_8UC1, cv::Scalar(110));
  EXPECT_LT(FlowOf(Exposed(wall, 1, 3, 1), Exposed(wall, 1, 3, 2)).vectors.size(), 36U);
}

class RealLightTest : public ::testing::TestWithParam<std::string> {};

TEST_P(RealLightTest, NumberOfVectorsStays) {
  HOMING_SKIP_WITHOUT(GetParam());
  const auto images = ReadImages(RealSequence(GetParam()), 8);
  double reference = 0;
  double darker = 0;
  for (std::size_t i = 0; i + 1 < images.size(); ++i) {
    const auto number = [&](double gain, std::uint64_t seed) {
      return Summary(FlowOf(Exposed(images[i], gain, 2, seed),
                            Exposed(images[i + 1], gain, 2, seed + 1)))
          .number;
    };
    reference += number(1, 2 * i);
    darker += number(0.6, 100 + 2 * i);
  }
  EXPECT_NEAR(darker / reference, 1, 0.15);
}

INSTANTIATE_TEST_SUITE_P(Sequences, RealLightTest,
                         ::testing::Values("laps/lap1", "gantry/row08", "shop/row13"));

}  // namespace
}  // namespace homing
