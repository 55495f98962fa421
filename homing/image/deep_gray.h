// Grey values of more than 8 bits to 8 bits.
#ifndef HOMING_IMAGE_DEEP_GRAY_H_
#define HOMING_IMAGE_DEEP_GRAY_H_

#include <opencv2/core.hpp>

namespace homing {

// Maps the range of values that the image uses to 0..255; one value in a thousand at either end is
// cut off, so that dead pixels do not decide. A thermal camera uses a small part of its 16 bits:
// the upper byte alone would leave a few grey levels. REQUIRES: one channel, CV_16U or CV_32F.
cv::Mat StretchToGray8(const cv::Mat& deep);

}  // namespace homing

#endif  // HOMING_IMAGE_DEEP_GRAY_H_
