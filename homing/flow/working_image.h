// The image that corners are found in and tracked: resized, smoothed, and normalised by local mean
// and deviation, so that light and exposure have no effect. The paper's
// method assumes constant brightness (II-B, 1).
#ifndef HOMING_FLOW_WORKING_IMAGE_H_
#define HOMING_FLOW_WORKING_IMAGE_H_

#include <opencv2/core.hpp>

#include "homing/flow/flow_tracker.h"

namespace homing {

// Grey levels of the normalised 8-bit image for one local deviation; a local mean is 128.
inline constexpr double kLevelsPerDeviation = 40;

// Working size over source size, by axis. Converts points between the two images: pixel centres
// have whole numbers in both.
struct WorkingScale {
  double x = 1;
  double y = 1;

  cv::Point2d ToSource(const cv::Point2f& p) const {
    return {(double{p.x} + 0.5) / x - 0.5, (double{p.y} + 0.5) / y - 0.5};
  }
};

// Size of the working image of a source of this size.
cv::Size WorkingSize(const cv::Size& source, const FlowOptions& options);

// Intermediate images, reused for the next frame of the same size: allocating them took most of
// the time of a small frame.
struct WorkingBuffers {
  cv::Mat levels;
  cv::Mat resized;
  cv::Mat smoothed;
  cv::Mat mean;
  cv::Mat square;
  cv::Mat normalized;
};

// CV_32FC1 in local deviations from the local mean, of WorkingSize. `gray` is CV_8UC1. The result
// is in the buffers.
const cv::Mat& NormalizedImage(const cv::Mat& gray, const FlowOptions& options,
                               WorkingBuffers* buffers);
cv::Mat NormalizedImage(const cv::Mat& gray, const FlowOptions& options);

}  // namespace homing

#endif  // HOMING_FLOW_WORKING_IMAGE_H_
