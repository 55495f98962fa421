// Converts the camera description of robots and calibration programs to this program's Camera.
// Source: sensor_msgs/CameraInfo.
#ifndef CLIENT_BAG_CAMERA_INFO_H_
#define CLIENT_BAG_CAMERA_INFO_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "homing/flow/camera.h"

namespace homing::client {

struct CameraInfo {
  // Pixels.
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  // "plumb_bob", "rational_polynomial", "equidistant" (also "fisheye", "kannala_brandt") or empty.
  std::string distortion_model;
  std::vector<double> distortion;
  // Row by row: 3 x 3 of the raw image, 3 x 4 of the rectified one (may be empty).
  std::vector<double> matrix;
  std::vector<double> projection;
};

// `rectified`: the images are no longer distorted, as image_proc of ROS makes them.
// INVALID_ARGUMENT: no focal length, an unknown model, or values out of range.
absl::StatusOr<Camera> ToCamera(const CameraInfo& info, bool rectified);

}  // namespace homing::client

#endif  // CLIENT_BAG_CAMERA_INFO_H_
