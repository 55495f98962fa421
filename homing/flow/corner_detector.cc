#include "homing/flow/corner_detector.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace homing {
namespace {

// Window of the gradient matrix, working pixels.
constexpr int kBlockPx = 5;
// Gradients next to the border come from mirrored pixels.
constexpr int kBorderPx = 3;

// The smaller eigenvalue of the mean of grad I grad I^T (eq 3), per pixel: what is left of the
// squared gradient, 1 / px^2, in the direction that has least of it. Zero on an edge.
cv::Mat LeastEigenvalue(const cv::Mat& normalized) {
  cv::Mat result;
  cv::cornerMinEigenVal(normalized, result, kBlockPx, 3, cv::BORDER_REFLECT_101);
  // OpenCV's gradients are twice as steep, summed over the block instead of averaged by area.
  return result * 0.25F;
}

// The strongest local maximum in a cell, the first of equal ones.
std::optional<cv::Point> BestIn(const cv::Rect& cell, const cv::Mat& strength,
                                const cv::Mat& neighbourhood, float threshold) {
  std::optional<cv::Point> best;
  float best_strength = threshold;
  for (int y = cell.y; y < cell.y + cell.height; ++y) {
    const float* s = strength.ptr<float>(y);
    const float* n = neighbourhood.ptr<float>(y);
    for (int x = cell.x; x < cell.x + cell.width; ++x) {
      if (s[x] > best_strength && s[x] >= n[x]) {
        best_strength = s[x];
        best = cv::Point(x, y);
      }
    }
  }
  return best;
}

}  // namespace

std::vector<cv::Point2f> DetectCorners(const cv::Mat& normalized, const FlowOptions& options,
                                       double enlargement) {
  const cv::Mat strength = LeastEigenvalue(normalized);
  // A corner is the maximum of its neighbourhood, so that neighbours across a cell's border are
  // not counted twice.
  cv::Mat neighbourhood;
  const int side = 2 * (options.cell_px / 2) + 1;
  cv::dilate(strength, neighbourhood, cv::getStructuringElement(cv::MORPH_RECT, {side, side}));
  const cv::Rect inner(kBorderPx, kBorderPx, normalized.cols - 2 * kBorderPx,
                       normalized.rows - 2 * kBorderPx);
  // Enlarging an image flattens its gradients, those of noise as those of texture.
  const auto threshold = static_cast<float>(options.min_eigenvalue / (enlargement * enlargement));
  std::vector<cv::Point2f> corners;
  for (int y = 0; y < normalized.rows; y += options.cell_px) {
    for (int x = 0; x < normalized.cols; x += options.cell_px) {
      const cv::Rect cell = cv::Rect(x, y, options.cell_px, options.cell_px) & inner;
      if (const auto best = BestIn(cell, strength, neighbourhood, threshold)) {
        corners.emplace_back(static_cast<float>(best->x), static_cast<float>(best->y));
      }
    }
  }
  return corners;
}

}  // namespace homing
