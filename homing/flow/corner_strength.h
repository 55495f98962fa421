// Minimum-eigenvalue response of each pixel: the smaller eigenvalue of eq 3's matrix. Source: paper
// II-B, eqs 3 to 5. Only five rows are kept in memory.
#ifndef HOMING_FLOW_CORNER_STRENGTH_H_
#define HOMING_FLOW_CORNER_STRENGTH_H_

#include <opencv2/core.hpp>

namespace homing {

// Window of the gradient matrix, pixels.
inline constexpr int kCornerBlockPx = 5;

// Strength of an image whose gradient matrix, averaged over the window, has this smaller eigenvalue
// (squared units of the image over px^2).
constexpr float StrengthOf(double eigenvalue) {
  // CornerStrength leaves out the divisions by the kernel's 8 and by the window's area.
  return static_cast<float>(eigenvalue * 8 * 8 * kCornerBlockPx * kCornerBlockPx);
}

// `image` and `strength` are CV_32FC1; what lies beyond the border is mirrored. The same to the bit
// on every machine. REQUIRES: sides of at least 5 px.
void CornerStrength(const cv::Mat& image, cv::Mat* strength);

}  // namespace homing

#endif  // HOMING_FLOW_CORNER_STRENGTH_H_
