#include "homing/image/deep_gray.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace homing {
namespace {

constexpr std::size_t kCutShare = 1000;

struct Range {
  double low = 0;
  double high = 0;
};

Range RangeOf16Bit(const cv::Mat& deep) {
  std::vector<std::size_t> counts(65536);
  for (int y = 0; y < deep.rows; ++y) {
    const auto* row = deep.ptr<std::uint16_t>(y);
    for (int x = 0; x < deep.cols; ++x) ++counts[row[x]];
  }
  const std::size_t cut = deep.total() / kCutShare;
  std::size_t low = 0;
  for (std::size_t below = counts[0]; below <= cut; below += counts[low]) ++low;
  std::size_t high = counts.size() - 1;
  for (std::size_t above = counts[high]; above <= cut; above += counts[high]) --high;
  return {static_cast<double>(low), static_cast<double>(high)};
}

Range RangeOfFloat(const cv::Mat& deep) {
  std::vector<float> values;
  values.reserve(deep.total());
  for (int y = 0; y < deep.rows; ++y) {
    const auto* row = deep.ptr<float>(y);
    std::copy_if(row, row + deep.cols, std::back_inserter(values),
                 [](float value) { return std::isfinite(value); });
  }
  if (values.empty()) return {};
  const auto cut = static_cast<std::ptrdiff_t>(values.size() / kCutShare);
  std::nth_element(values.begin(), values.begin() + cut, values.end());
  const double low = values[static_cast<std::size_t>(cut)];
  std::nth_element(values.begin(), values.end() - 1 - cut, values.end());
  return {low, *(values.end() - 1 - cut)};
}

}  // namespace

cv::Mat StretchToGray8(const cv::Mat& deep) {
  const Range range = deep.depth() == CV_16U ? RangeOf16Bit(deep) : RangeOfFloat(deep);
  const double span = range.high - range.low;
  cv::Mat gray;
  const double scale = span > 0 ? 255 / span : 0;
  deep.convertTo(gray, CV_8U, scale, span > 0 ? -range.low * scale : 128);
  return gray;
}

}  // namespace homing
