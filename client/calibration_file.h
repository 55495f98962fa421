// Files that calibration programs write. Source: the formats' own descriptions.
#ifndef CLIENT_CALIBRATION_FILE_H_
#define CLIENT_CALIBRATION_FILE_H_

#include <string>

#include "absl/status/statusor.h"
#include "homing/flow/camera.h"

namespace homing::client {

// FILE[#CAMERA]: camera_info of ROS (YAML), the camera chain of kalibr (YAML; CAMERA is cam0, cam1,
// ..., needed where it has several), or a file of OpenCV (YAML or XML) with camera_matrix and
// distortion_coefficients. NOT_FOUND, PERMISSION_DENIED; INVALID_ARGUMENT names the file and the
// error.
absl::StatusOr<Camera> ReadCalibrationFile(const std::string& name);

}  // namespace homing::client

#endif  // CLIENT_CALIBRATION_FILE_H_
