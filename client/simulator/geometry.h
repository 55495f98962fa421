// Vectors and poses of the simulated world: x and y on the ground, z up, metres.
#ifndef CLIENT_SIMULATOR_GEOMETRY_H_
#define CLIENT_SIMULATOR_GEOMETRY_H_

#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>

#include "homing/flow/observation.h"

namespace homing::client {

using Vector2 = cv::Vec2d;
using Vector3 = cv::Vec3d;

// A pose on the ground. The heading is that of the OUTBOUND direction, anticlockwise from x, rad.
struct Pose {
  Vector2 position;
  double heading = 0;

  Vector2 Along() const { return {std::cos(heading), std::sin(heading)}; }
  // Unit vector to the left of the outbound direction.
  Vector2 Left() const { return {-std::sin(heading), std::cos(heading)}; }
  // A point of the ground this far along and to the left.
  Vector2 At(double along_m, double left_m) const {
    return position + along_m * Along() + left_m * Left();
  }
};

// A full turn and a degree, radians.
inline constexpr double kTurn = 2 * std::numbers::pi;
inline constexpr double kDegree = std::numbers::pi / 180;

inline Vector3 Raise(const Vector2& ground, double z) { return {ground[0], ground[1], z}; }

// A camera that neither pitches nor rolls. Camera coordinates: X right, Y down, Z forward.
struct CameraPose {
  Vector3 origin;
  Vector3 right;
  Vector3 forward;

  Vector3 FromWorld(const Vector3& point) const { return Turned(point - origin); }
  Vector3 ToWorld(const Vector3& point) const { return origin + TurnedBack(point); }
  // Directions.
  Vector3 Turned(const Vector3& direction) const {
    return {direction.dot(right), -direction[2], direction.dot(forward)};
  }
  Vector3 TurnedBack(const Vector3& direction) const {
    return direction[0] * right + Vector3(0, 0, -direction[1]) + direction[2] * forward;
  }
};

// The camera that looks square to the route at `side` of it. Its x axis points the same way of the
// world whichever way the robot heads.
inline CameraPose LookAside(const Pose& pose, double height_m, Side side) {
  const double sign = side == Side::kLeft ? 1 : -1;
  return {Raise(pose.position, height_m), Raise(sign * pose.Along(), 0),
          Raise(sign * pose.Left(), 0)};
}

// The same camera turned clockwise about the vertical axis (seen from above), radians.
inline CameraPose TurnedClockwise(const CameraPose& camera, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const auto turn = [&](const Vector3& v) {
    return Vector3(c * v[0] + s * v[1], c * v[1] - s * v[0], v[2]);
  };
  return {camera.origin, turn(camera.right), turn(camera.forward)};
}

// A ray in camera coordinates with Z = 1: the point at depth d is d (x, y, 1).
struct Ray {
  double x = 0;
  double y = 0;
};

// The camera sees nothing nearer than this, m.
inline constexpr double kNearest = 0.05;
// The depth of an infinitely distant surface, m.
inline constexpr double kFarAway = 1e9;
// The depth of a ray that hits no surface.
inline constexpr double kNothing = 1e30;

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_GEOMETRY_H_
