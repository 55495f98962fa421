// The orientation of a camera, as the EXIF part of its images gives it.
#ifndef HOMING_IMAGE_ORIENTATION_H_
#define HOMING_IMAGE_ORIENTATION_H_

#include <opencv2/core.hpp>
#include <string_view>

namespace homing {

// EXIF's number, 1 to 8, of a JPEG, PNG or WebP file; 1 (upright) where it has none.
int ExifOrientation(std::string_view file);

// Width and height change places when an image is turned upright.
inline bool ExchangesSides(int orientation) { return orientation >= 5 && orientation <= 8; }
// Turns and mirrors `image` upright. Other numbers than 2 to 8 leave it as it is.
cv::Mat TurnUpright(const cv::Mat& image, int orientation);

}  // namespace homing

#endif  // HOMING_IMAGE_ORIENTATION_H_
