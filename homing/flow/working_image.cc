#include "homing/flow/working_image.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "homing/base/vector_clones.h"

namespace homing {
namespace {

// Enlarging by more than two adds no information. A smaller side holds no tracking window.
constexpr double kMaxScale = 2;
constexpr int kMinSidePx = 16;

// Resized and smoothed, CV_32FC1: 8 bits would lose a dim image's texture.
const cv::Mat& SmoothedImage(const cv::Mat& gray, const FlowOptions& options,
                             WorkingBuffers* buffers) {
  const cv::Size size = WorkingSize(gray.size(), options);
  gray.convertTo(buffers->levels, CV_32F);
  const cv::Mat* image = &buffers->levels;
  if (size != gray.size()) {
    const bool smaller = size.width < gray.cols;
    cv::resize(*image, buffers->resized, size, 0, 0, smaller ? cv::INTER_AREA : cv::INTER_LINEAR);
    image = &buffers->resized;
  }
  if (options.smoothing_sigma_px > 0) {
    const double sigma = options.smoothing_sigma_px * std::max(1.0, double(size.width) / gray.cols);
    cv::GaussianBlur(*image, buffers->smoothed, cv::Size(), sigma, sigma, cv::BORDER_REFLECT_101);
    image = &buffers->smoothed;
  }
  return *image;
}

// Normalises one row: (value - local mean) / local deviation. Bit-identical on every machine.
HOMING_VECTOR_CLONES
void NormalizeRow(const float* in, const float* mean, const float* square, float floor, int size,
                  float* out) {
  for (int x = 0; x < size; ++x) {
    const float deviation = std::sqrt(std::max(0.0F, square[x] - mean[x] * mean[x]));
    out[x] = (in[x] - mean[x]) / (deviation + floor);
  }
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

const cv::Mat& NormalizedImage(const cv::Mat& gray, const FlowOptions& options,
                               WorkingBuffers* buffers) {
  const cv::Mat& image = SmoothedImage(gray, options, buffers);
  const cv::Size window(options.normalization_window_px, options.normalization_window_px);
  cv::boxFilter(image, buffers->mean, CV_32F, window, cv::Point(-1, -1), true,
                cv::BORDER_REFLECT_101);
  cv::sqrBoxFilter(image, buffers->square, CV_32F, window, cv::Point(-1, -1), true,
                   cv::BORDER_REFLECT_101);
  const auto floor = static_cast<float>(options.normalization_floor);
  buffers->normalized.create(image.size(), CV_32FC1);
  for (int y = 0; y < image.rows; ++y) {
    NormalizeRow(image.ptr<float>(y), buffers->mean.ptr<float>(y), buffers->square.ptr<float>(y),
                 floor, image.cols, buffers->normalized.ptr<float>(y));
  }
  return buffers->normalized;
}

cv::Mat NormalizedImage(const cv::Mat& gray, const FlowOptions& options) {
  WorkingBuffers buffers;
  return NormalizedImage(gray, options, &buffers);
}

}  // namespace homing
