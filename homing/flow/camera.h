// Pinhole camera with distortion and yaw: raw flow vectors to those of an ideal camera that looks
// square to the direction of travel. Points are undistorted first.
#ifndef HOMING_FLOW_CAMERA_H_
#define HOMING_FLOW_CAMERA_H_

#include <array>
#include <optional>

#include "absl/status/status.h"
#include "homing/flow/flow_vector.h"

namespace homing {

// Pixels. Focal lengths in (0, 1e6], principal point in [-1e6, 1e6].
struct Intrinsics {
  double focal_x = 0;
  double focal_y = 0;
  double center_x = 0;
  double center_y = 0;
  friend bool operator==(const Intrinsics&, const Intrinsics&) = default;
};

struct Camera {
  // Pixels, [0, 65536]; both 0: not known yet (taken from the first observation).
  int width = 0;
  int height = 0;
  // Absent: everything works in raw pixels, and there must be no distortion and no yaw.
  std::optional<Intrinsics> intrinsics;
  // k1, k2, p1, p2, k3, k4, k5, k6; if fisheye k1, k2, k3, k4 and zeros. Each in [-100, 100].
  // Models: undistortion.h.
  std::array<double, 8> distortion{};
  bool fisheye = false;
  // Rad, positive clockwise seen from above, (-pi/2, pi/2).
  double yaw_rad = 0;
  friend bool operator==(const Camera&, const Camera&) = default;
};

// INVALID_ARGUMENT naming field, value and limit.
absl::Status Validate(const Camera& camera);

// The focal length assumed for a camera without intrinsics: a field of view of 60 degrees. Pixels.
double UsualFocal(int width);

// The vectors that the ideal camera of the same intrinsics would have seen. Without intrinsics: the
// same vectors. Vectors that the ideal camera cannot see, and non-finite ones, are dropped.
FlowField Rectify(const FlowField& raw, const Camera& camera);

}  // namespace homing

#endif  // HOMING_FLOW_CAMERA_H_
