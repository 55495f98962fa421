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

// OpenCV's gradients are twice as steep, summed over the block instead of averaged by area.
constexpr float kOpenCvScale = 4;

// The smaller eigenvalue of the mean of grad I grad I^T (eq 3), per pixel and times kOpenCvScale:
// what is left of the squared gradient, 1 / px^2, in the direction that has least of it. Zero on an
// edge.
cv::Mat LeastEigenvalue(const cv::Mat& normalized) {
  cv::Mat result;
  cv::cornerMinEigenVal(normalized, result, kBlockPx, 3, cv::BORDER_REFLECT_101);
  return result;
}

// None within `reach` pixels is stronger.
bool IsLocalMaximum(const cv::Mat& strength, int x, int y, int reach) {
  const float here = strength.ptr<float>(y)[x];
  const int left = std::max(0, x - reach);
  const int right = std::min(strength.cols - 1, x + reach);
  // Outwards: a stronger one is near as a rule.
  for (int away = 0; away <= reach; ++away) {
    for (const int row : {y - away, y + away}) {
      if (row < 0 || row >= strength.rows) continue;
      const float* s = strength.ptr<float>(row);
      for (int column = left; column <= right; ++column) {
        if (s[column] > here) return false;
      }
    }
  }
  return true;
}

// The strongest local maximum in a cell, the first of equal ones.
std::optional<cv::Point> BestIn(const cv::Rect& cell, const cv::Mat& strength, int reach,
                                float threshold) {
  std::optional<cv::Point> best;
  float best_strength = threshold;
  for (int y = cell.y; y < cell.y + cell.height; ++y) {
    const float* s = strength.ptr<float>(y);
    for (int x = cell.x; x < cell.x + cell.width; ++x) {
      if (s[x] > best_strength && IsLocalMaximum(strength, x, y, reach)) {
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
  const cv::Rect inner(kBorderPx, kBorderPx, normalized.cols - 2 * kBorderPx,
                       normalized.rows - 2 * kBorderPx);
  // Enlarging an image flattens its gradients, those of noise as those of texture.
  const auto threshold =
      kOpenCvScale * static_cast<float>(options.min_eigenvalue / (enlargement * enlargement));
  std::vector<cv::Point2f> corners;
  for (int y = 0; y < normalized.rows; y += options.cell_px) {
    for (int x = 0; x < normalized.cols; x += options.cell_px) {
      const cv::Rect cell = cv::Rect(x, y, options.cell_px, options.cell_px) & inner;
      // A corner is the maximum of its neighbourhood, so that neighbours across a cell's border are
      // not counted twice.
      if (const auto best = BestIn(cell, strength, options.cell_px / 2, threshold)) {
        corners.emplace_back(static_cast<float>(best->x), static_cast<float>(best->y));
      }
    }
  }
  return corners;
}

}  // namespace homing
