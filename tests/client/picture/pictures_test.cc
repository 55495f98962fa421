#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "client/picture/deviation_picture.h"
#include "client/picture/flow_picture.h"
#include "client/picture/journey_strip.h"
#include "client/picture/position_picture.h"
#include "homing/image/frame.h"
#include "tests/support/status_matchers.h"

namespace homing::client {
namespace {

// Draws into a new file and reads it back.
class PicturesTest : public ::testing::Test {
 protected:
  ~PicturesTest() override { std::filesystem::remove(path_); }

  cv::Mat Image() const {
    std::ifstream file(path_, std::ios::binary);
    std::ostringstream bytes;
    bytes << file.rdbuf();
    const std::string text = bytes.str();
    const auto gray = DecodeGray({FrameEncoding::kPng, 0, 0, text});
    EXPECT_THAT(gray, IsOk());
    return gray.ok() ? *gray : cv::Mat();
  }
  // Share of the pixels that are not white.
  double Ink() const {
    const cv::Mat image = Image();
    int dark = 0;
    for (int y = 0; y < image.rows; ++y) {
      for (int x = 0; x < image.cols; ++x) dark += image.at<unsigned char>(y, x) < 200 ? 1 : 0;
    }
    return image.empty() ? 0 : static_cast<double>(dark) / static_cast<double>(image.total());
  }

  std::string path_ = (std::filesystem::temp_directory_path() /
                       ("homing_picture_" + std::to_string(::getpid()) + ".png"))
                          .string();
};

// Two clusters of vectors, left and right.
FlowField TwoClusters() {
  FlowField field{320, 240, {}};
  for (int i = 0; i < 40; ++i) {
    const auto x = static_cast<float>(i % 8) * 8 + (i < 20 ? 20 : 220);
    const auto y = static_cast<float>(60 + 3 * i);
    field.vectors.push_back({x, y, x + 5, y});
  }
  return field;
}

TEST_F(PicturesTest, FlowShowsItsVectors) {
  FlowPictureOptions options;
  ASSERT_THAT(DrawFlow(path_, {{"left", FlowField{320, 240, {}}, {}, {}}}, options), IsOk());
  const double empty = Ink();
  ASSERT_THAT(DrawFlow(path_, {{"left", TwoClusters(), {}, {}}}, options), IsOk());
  EXPECT_GT(Ink(), 1.2 * empty);
}

TEST_F(PicturesTest, FlowWithHistogramAndReferenceIsTaller) {
  FlowPictureOptions options;
  FlowPanel panel{"left", TwoClusters(), {}, TwoClusters()};
  ASSERT_THAT(DrawFlow(path_, {panel}, options), IsOk());
  const cv::Mat alone = Image();
  options.histogram = true;
  ASSERT_THAT(DrawFlow(path_, {panel, panel}, options), IsOk());
  const cv::Mat both = Image();
  EXPECT_GT(both.rows, alone.rows + 200);
  EXPECT_EQ(both.cols, 2 * alone.cols);
}

TEST_F(PicturesTest, TrainingIsDrawnForAnyDeviations) {
  DeviationModel model;
  std::vector<double> deviations;
  for (int i = 1; i < 1000; ++i) deviations.push_back(std::exp(model.mu + 0.001 * i));
  ASSERT_THAT(DrawDeviationDensity(path_, deviations, model), IsOk());
  EXPECT_GT(Ink(), 0.01);
  ASSERT_THAT(DrawDeviationDistribution(path_, deviations, model), IsOk());
  EXPECT_GT(Ink(), 0.005);
  EXPECT_THAT(DrawDeviationDensity(path_, {0.0}, model), IsOk());
}

TEST_F(PicturesTest, StripShowsFingerprints) {
  JourneyStrip strip;
  strip.title = "robots/a/journeys/b";
  strip.step_count = 100;
  ASSERT_THAT(DrawJourneyStrip(path_, strip), IsOk());
  const double empty = Ink();
  for (int step = 0; step < 100; ++step) {
    strip.fingerprints.push_back(
        {step, Side::kLeft, {static_cast<float>(3 * step), 100, 50, step / 10}});
  }
  ASSERT_THAT(DrawJourneyStrip(path_, strip), IsOk());
  EXPECT_GT(Ink(), empty);
  ASSERT_THAT(DrawJourneyStep(path_, strip, 5), IsOk());
  EXPECT_GT(Ink(), 0.003);
}

TEST_F(PicturesTest, WayHomeIsDrawnWithAndWithoutTruth) {
  PositionPicture picture;
  for (int i = 0; i < 50; ++i) {
    picture.places.push_back({i, 50.0 - i, 50.5 - i, 0.02 * i, i > 10});
  }
  picture.places[7].believed.reset();
  ASSERT_THAT(DrawPositions(path_, picture), IsOk());
  const int with_truth = Image().rows;
  for (BelievedPlace& place : picture.places) place.truth.reset();
  ASSERT_THAT(DrawPositions(path_, picture), IsOk());
  EXPECT_LT(Image().rows, with_truth);
  EXPECT_THAT(DrawPositions(path_, {}), IsOk());
}

}  // namespace
}  // namespace homing::client
