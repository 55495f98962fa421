#include "homing/flow/working_image.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace homing {
namespace {

// More than doubled there is nothing more to see; below this side there is no window to track.
constexpr double kMaxScale = 2;
constexpr int kMinSidePx = 16;

// Resized and smoothed, CV_32FC1: 8 bits would lose a dim image's texture.
cv::Mat SmoothedImage(const cv::Mat& gray, const FlowOptions& options) {
  const cv::Size size = WorkingSize(gray.size(), options);
  cv::Mat image;
  gray.convertTo(image, CV_32F);
  if (size != gray.size()) {
    const bool smaller = size.width < gray.cols;
    cv::Mat resized;
    cv::resize(image, resized, size, 0, 0, smaller ? cv::INTER_AREA : cv::INTER_LINEAR);
    image = resized;
  }
  if (options.smoothing_sigma_px > 0) {
    const double sigma = options.smoothing_sigma_px * std::max(1.0, double(size.width) / gray.cols);
    cv::GaussianBlur(image, image, cv::Size(), sigma, sigma, cv::BORDER_REFLECT_101);
  }
  return image;
}

}  // namespace

cv::Size WorkingSize(const cv::Size& source, const FlowOptions& options) {
  if (options.working_width_px == 0) {
    return source;
  }
  const double scale = std::min(kMaxScale, double(options.working_width_px) / source.width);
  const auto side = [scale](int length) {
    return std::max(kMinSidePx, static_cast<int>(std::lround(length * scale)));
  };
  return {side(source.width), side(source.height)};
}

cv::Mat NormalizedImage(const cv::Mat& gray, const FlowOptions& options) {
  const cv::Mat image = SmoothedImage(gray, options);
  const cv::Size window(options.normalization_window_px, options.normalization_window_px);
  cv::Mat mean;
  cv::Mat variance;
  cv::boxFilter(image, mean, CV_32F, window, cv::Point(-1, -1), true, cv::BORDER_REFLECT_101);
  cv::sqrBoxFilter(image, variance, CV_32F, window, cv::Point(-1, -1), true,
                   cv::BORDER_REFLECT_101);
  const auto floor = static_cast<float>(options.normalization_floor);
  cv::Mat result(image.size(), CV_32FC1);
  for (int y = 0; y < image.rows; ++y) {
    const float* in = image.ptr<float>(y);
    const float* m = mean.ptr<float>(y);
    const float* square = variance.ptr<float>(y);
    float* out = result.ptr<float>(y);
    for (int x = 0; x < image.cols; ++x) {
      const float deviation = std::sqrt(std::max(0.0F, square[x] - m[x] * m[x]));
      out[x] = (in[x] - m[x]) / (deviation + floor);
    }
  }
  return result;
}

}  // namespace homing
