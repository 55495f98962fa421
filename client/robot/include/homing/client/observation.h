// What a robot sees at one instant.
#ifndef HOMING_CLIENT_OBSERVATION_H_
#define HOMING_CLIENT_OBSERVATION_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace homing::robot {

enum class Encoding {
  // One byte a pixel, row-major, no padding.
  kGray8,
  // Three bytes a pixel.
  kRgb8,
  kBgr8,
  // Whole files; width and height may be 0.
  kJpeg,
  kPng,
};

// One image. The bytes are copied by the call that takes the observation.
struct Image {
  Encoding encoding = Encoding::kGray8;
  int width = 0;
  int height = 0;
  const void* data = nullptr;
  std::size_t size = 0;
};

// One tracked corner, pixels of the source image, origin top left.
struct FlowVector {
  float start_x = 0;
  float start_y = 0;
  float end_x = 0;
  float end_y = 0;
};

// The optical flow from the observation before to this one, computed by the robot: it needs a
// hundredth of the bandwidth of frames.
struct Flow {
  // Size of the images, pixels.
  int width = 0;
  int height = 0;
  std::vector<FlowVector> vectors = {};
};

// One camera: an image, or flow. A journey is recorded with one kind from its beginning to its end.
struct View {
  std::optional<Image> image = {};
  std::optional<Flow> flow = {};
};

// One instant, with the left camera, the right one or both.
struct Observation {
  std::optional<View> left = {};
  std::optional<View> right = {};
  // By the robot's clock, nanoseconds since 1970; 0: not known.
  std::int64_t capture_time_ns = 0;
  // Observations before this one are missing, or the robot was moved: no step spans this point.
  bool break_before = false;
};

// A camera's geometry; all of it is optional.
struct Camera {
  // Focal lengths and principal point, pixels.
  double focal_x = 0;
  double focal_y = 0;
  double center_x = 0;
  double center_y = 0;
  // k1, k2, p1, p2, k3, k4, k5, k6 as OpenCV has them: none, 4, 5 or 8; for fisheye the 4 of that
  // model.
  std::vector<double> distortion = {};
  bool fisheye = false;
  // Rotation away from square to the direction of travel, clockwise seen from above, radians.
  double yaw_rad = 0;
};

// Sides are those of the route as the outbound robot met it, not of the robot.
enum class Side { kUnknown = 0, kLeft = 1, kRight = 2 };
enum class Motion { kUnknown = 0, kMoving = 1, kStanding = 2, kTurning = 3 };

}  // namespace homing::robot

#endif  // HOMING_CLIENT_OBSERVATION_H_
