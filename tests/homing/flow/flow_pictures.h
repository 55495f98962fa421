// Synthetic pictures whose motion is known exactly.
#ifndef TESTS_HOMING_FLOW_FLOW_PICTURES_H_
#define TESTS_HOMING_FLOW_FLOW_PICTURES_H_

#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>

#include "homing/flow/flow_tracker.h"

namespace homing {

// A smooth aperiodic texture by position, grey levels 40 to 200; whatever the translation, exact.
inline double TextureAt(double x, double y) {
  double sum = 0;
  for (int k = 1; k <= 12; ++k) {
    const double angle = 2.399963 * k;
    const double wave = 0.10 + 0.045 * k;
    sum += std::sin(wave * (x * std::cos(angle) + y * std::sin(angle)) + 1.7 * k * k);
  }
  return 120 + 80 * std::tanh(sum / 3.5);
}

// The texture moved by (u, v) pixels, `zoom` times as large.
inline cv::Mat TexturePicture(int width, int height, double u, double v, double zoom = 1) {
  cv::Mat picture(height, width, CV_8UC1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      picture.at<unsigned char>(y, x) =
          cv::saturate_cast<unsigned char>(TextureAt((x - u) / zoom, (y - v) / zoom));
    }
  }
  return picture;
}

// Exposure `gain` and sensor noise `sigma`, grey levels; the same for the same seed.
inline cv::Mat Exposed(const cv::Mat& picture, double gain, double sigma, std::uint64_t seed) {
  cv::RNG random(seed);
  cv::Mat result = picture.clone();
  for (int y = 0; y < result.rows; ++y) {
    for (int x = 0; x < result.cols; ++x) {
      auto& pixel = result.at<unsigned char>(y, x);
      const double noise = sigma > 0 ? random.gaussian(sigma) : 0;
      pixel = cv::saturate_cast<unsigned char>(gain * pixel + noise);
    }
  }
  return result;
}

inline FlowField FlowOf(const cv::Mat& before, const cv::Mat& now,
                        const FlowOptions& options = {}) {
  FlowTracker tracker(options);
  (void)tracker.Track(before).value();
  tracker.Advance();
  return tracker.Track(now).value().value();
}

}  // namespace homing

#endif  // TESTS_HOMING_FLOW_FLOW_PICTURES_H_
