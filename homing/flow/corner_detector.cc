#include "homing/flow/corner_detector.h"

#include <algorithm>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "homing/flow/corner_strength.h"

namespace homing {
namespace {

// Gradients next to the border come from mirrored pixels.
constexpr int kBorderPx = 3;

// The strongest local maximum of a cell; of equal ones the first. `strongest` holds the maximum of
// each pixel's neighbourhood.
std::optional<cv::Point> BestIn(const cv::Rect& cell, const cv::Mat& strength,
                                const cv::Mat& strongest, float threshold) {
  std::optional<cv::Point> best;
  float best_strength = threshold;
  for (int y = cell.y; y < cell.y + cell.height; ++y) {
    const float* s = strength.ptr<float>(y);
    const float* most = strongest.ptr<float>(y);
    for (int x = cell.x; x < cell.x + cell.width; ++x) {
      if (s[x] > best_strength && s[x] == most[x]) {
        best_strength = s[x];
        best = cv::Point(x, y);
      }
    }
  }
  return best;
}

// The strongest `most`, the first of equal ones, in their order.
void KeepStrongest(const cv::Mat& strength, std::size_t most, std::vector<cv::Point2f>* corners) {
  if (corners->size() <= most) return;
  const auto strength_of = [&](const cv::Point2f& corner) {
    return strength.at<float>(static_cast<int>(corner.y), static_cast<int>(corner.x));
  };
  std::vector<float> strengths;
  for (const cv::Point2f& corner : *corners) strengths.push_back(strength_of(corner));
  const auto last = strengths.begin() + static_cast<std::ptrdiff_t>(most) - 1;
  std::nth_element(strengths.begin(), last, strengths.end(), std::greater<>());
  auto equal = 1 + std::count(strengths.begin(), last, *last);
  std::erase_if(*corners, [&, weakest = *last](const cv::Point2f& corner) {
    const float its = strength_of(corner);
    return its < weakest || (its == weakest && equal-- <= 0);
  });
}

}  // namespace

std::vector<cv::Point2f> DetectCorners(const cv::Mat& normalized, const FlowOptions& options,
                                       double enlargement, CornerBuffers* buffers) {
  CornerStrength(normalized, &buffers->strength);
  // A corner is the maximum of its neighbourhood, so that neighbours across a cell's border are not
  // counted twice.
  const int side = 2 * (options.cell_px / 2) + 1;
  cv::dilate(buffers->strength, buffers->strongest, cv::Mat::ones(side, side, CV_8U));
  const cv::Rect inner(kBorderPx, kBorderPx, normalized.cols - 2 * kBorderPx,
                       normalized.rows - 2 * kBorderPx);
  // Enlarging an image flattens its gradients, those of noise as those of texture.
  const float threshold = StrengthOf(options.min_eigenvalue / (enlargement * enlargement));
  std::vector<cv::Point2f> corners;
  for (int y = 0; y < normalized.rows; y += options.cell_px) {
    for (int x = 0; x < normalized.cols; x += options.cell_px) {
      const cv::Rect cell = cv::Rect(x, y, options.cell_px, options.cell_px) & inner;
      if (const auto best = BestIn(cell, buffers->strength, buffers->strongest, threshold)) {
        corners.emplace_back(static_cast<float>(best->x), static_cast<float>(best->y));
      }
    }
  }
  const auto window_px = static_cast<std::size_t>(options.window_px);
  const std::size_t window = window_px * window_px;
  KeepStrongest(buffers->strength, kMostWindowPixels / window, &corners);
  return corners;
}

std::vector<cv::Point2f> DetectCorners(const cv::Mat& normalized, const FlowOptions& options,
                                       double enlargement) {
  CornerBuffers buffers;
  return DetectCorners(normalized, options, enlargement, &buffers);
}

}  // namespace homing
