#include "client/simulator/sensor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "client/simulator/view.h"

namespace homing::client {
namespace {

std::vector<float> Grey(float level) { return std::vector<float>(kPixelCount, level); }

struct MeanAndDeviation {
  double mean;
  double deviation;
};
MeanAndDeviation Measure(const cv::Mat& image) {
  double sum = 0;
  double squares = 0;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const double value = image.at<std::uint8_t>(y, x);
      sum += value;
      squares += value * value;
    }
  }
  const auto count = static_cast<double>(image.total());
  return {sum / count, std::sqrt(squares / count - sum * sum / count / count)};
}

TEST(SensorTest, NoiseHasItsSigma) {
  for (const double sigma : {2.0, 6.0}) {
    const Sensor sensor{.light = 1, .noise = sigma, .drive_seed = 3};
    const auto measured = Measure(sensor.Expose(Grey(100), 5, Side::kLeft));
    // Rounding to whole levels adds a variance of 1/12.
    EXPECT_NEAR(measured.deviation, std::sqrt(sigma * sigma + 1.0 / 12), 0.05);
    EXPECT_NEAR(measured.mean, 100 * sensor.Gain(5, Side::kLeft), 0.1);
  }
}

TEST(SensorTest, GainStaysWithinTenPercentOfTheLightAndUsesAllOfIt) {
  const Sensor sensor{.light = 0.5, .noise = 2, .drive_seed = 3};
  double low = 9;
  double high = 0;
  for (std::int64_t frame = 0; frame < 1000; ++frame) {
    const double gain = sensor.Gain(frame, Side::kRight);
    low = std::min(low, gain);
    high = std::max(high, gain);
  }
  EXPECT_GE(low, 0.45);
  EXPECT_LE(high, 0.55);
  EXPECT_LT(low, 0.451);
  EXPECT_GT(high, 0.549);
}

TEST(SensorTest, DrivesFramesAndCamerasDifferInNoiseAndGain) {
  const Sensor sensor{.light = 1, .noise = 2, .drive_seed = 3};
  const Sensor other{.light = 1, .noise = 2, .drive_seed = 4};
  EXPECT_NE(sensor.Gain(0, Side::kLeft), other.Gain(0, Side::kLeft));
  EXPECT_NE(sensor.Gain(0, Side::kLeft), sensor.Gain(1, Side::kLeft));
  EXPECT_NE(sensor.Gain(0, Side::kLeft), sensor.Gain(0, Side::kRight));
}

TEST(SensorTest, NoiseOfNeighboursIsUncorrelated) {
  const Sensor sensor{.light = 1, .noise = 10, .drive_seed = 3};
  const cv::Mat image = sensor.Expose(Grey(128), 0, Side::kLeft);
  const double mean = Measure(image).mean;
  for (const int step : {1, 2, 3, 4, Simulator::kWidth}) {
    double sum = 0;
    const std::uint8_t* pixels = image.ptr<std::uint8_t>();
    const int count = static_cast<int>(image.total()) - step;
    for (int i = 0; i < count; ++i) {
      sum += (pixels[i] - mean) * (pixels[i + step] - mean);
    }
    EXPECT_NEAR(sum / count / 100, 0, 0.02) << step;
  }
}

TEST(SensorTest, BrightnessIsBoundedByTheWhiteOfTheImage) {
  const Sensor sensor{.light = 4, .noise = 2, .drive_seed = 3};
  EXPECT_EQ(Measure(sensor.Expose(Grey(200), 0, Side::kLeft)).mean, 255);
}

}  // namespace
}  // namespace homing::client
