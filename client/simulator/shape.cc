#include "client/simulator/shape.h"

#include <array>

namespace homing::client {
namespace {

// Bounds of an upright box about a centre in camera coordinates.
RayBounds BoxBounds(double center_x, double center_z, double radius, double top_y,
                    double bottom_y) {
  const double far_z = center_z + radius;
  if (far_z < kNearest) {
    return {};
  }
  const double near_z = std::max(center_z - radius, kNearest);
  const auto least = [&](double v) { return std::min(v / near_z, v / far_z); };
  const auto most = [&](double v) { return std::max(v / near_z, v / far_z); };
  return {{least(center_x - radius), least(top_y)}, {most(center_x + radius), most(bottom_y)}};
}

void Include(const Vector3& point, RayBounds& bounds) {
  bounds.low.x = std::min(bounds.low.x, point[0] / point[2]);
  bounds.low.y = std::min(bounds.low.y, point[1] / point[2]);
  bounds.high.x = std::max(bounds.high.x, point[0] / point[2]);
  bounds.high.y = std::max(bounds.high.y, point[1] / point[2]);
}

// Height of the skyline over the horizon at an azimuth, as a slope.
constexpr double kHighestSkyline = 0.11;
double SkylineSlope(double azimuth) {
  return 0.05 + 0.03 * std::sin(7 * azimuth) + 0.02 * std::sin(17 * azimuth + 1) +
         0.01 * std::sin(43 * azimuth + 2);
}

}  // namespace

// corner + a edge_u + b edge_v = depth * ray by Cramer's rule: every unknown is a linear form of
// the ray over the same linear form.
ViewedParallelogram::ViewedParallelogram(const Parallelogram& shape, const CameraPose& camera)
    : corner(camera.FromWorld(shape.corner)),
      edge_u(camera.Turned(shape.edge_u)),
      edge_v(camera.Turned(shape.edge_v)),
      normal(edge_u.cross(edge_v)),
      row_u(edge_v.cross(corner)),
      row_v(corner.cross(edge_u)),
      depth_times_divisor(normal.dot(corner)) {}

Vector2 ViewedParallelogram::Texture(const Ray& ray, double depth) const {
  const Vector3 point = depth * Vector3(ray.x, ray.y, 1);
  const double divisor = normal.dot(point);
  return {cv::norm(edge_u) * row_u.dot(point) / divisor,
          cv::norm(edge_v) * row_v.dot(point) / divisor};
}

RayBounds ViewedParallelogram::Bounds() const {
  const std::array<Vector3, 4> corners = {corner, corner + edge_u, corner + edge_u + edge_v,
                                          corner + edge_v};
  RayBounds bounds{{kFarAway, kFarAway}, {-kFarAway, -kFarAway}};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3& a = corners[i];
    const Vector3& b = corners[(i + 1) % corners.size()];
    if (a[2] >= kNearest) {
      Include(a, bounds);
    }
    if ((a[2] < kNearest) != (b[2] < kNearest)) {
      Include(a + (kNearest - a[2]) / (b[2] - a[2]) * (b - a), bounds);
    }
  }
  return bounds;
}

ViewedCylinder::ViewedCylinder(const Cylinder& shape, const CameraPose& pose)
    : radius(shape.radius), camera(pose) {
  const Vector3 foot = pose.FromWorld(Raise(shape.center, shape.bottom));
  center_x = foot[0];
  center_z = foot[2];
  bottom_y = foot[1];
  top_y = foot[1] - (shape.top - shape.bottom);
  margin = center_x * center_x + center_z * center_z - radius * radius;
}

Vector2 ViewedCylinder::Texture(const Ray& ray, double depth) const {
  const Vector3 outward = camera.TurnedBack({depth * ray.x - center_x, 0, depth - center_z});
  return {radius * std::atan2(outward[1], outward[0]), depth * ray.y - bottom_y};
}

RayBounds ViewedCylinder::Bounds() const {
  return BoxBounds(center_x, center_z, radius, top_y, bottom_y);
}

ViewedEllipsoid::ViewedEllipsoid(const Ellipsoid& shape, const CameraPose& camera)
    : center(camera.FromWorld(shape.center)), half_axes(shape.half_axes) {
  const double c = std::cos(shape.heading);
  const double s = std::sin(shape.heading);
  const auto to_unit = [&](const Vector3& v) {
    return Vector3((c * v[0] + s * v[1]) / half_axes[0], (c * v[1] - s * v[0]) / half_axes[1],
                   v[2] / half_axes[2]);
  };
  unit_x = to_unit(camera.TurnedBack({1, 0, 0}));
  unit_y = to_unit(camera.TurnedBack({0, 1, 0}));
  unit_z = to_unit(camera.TurnedBack({0, 0, 1}));
  unit_center = to_unit(shape.center - camera.origin);
  margin = unit_center.dot(unit_center) - 1;
}

Vector2 ViewedEllipsoid::Texture(const Ray& ray, double depth) const {
  const Vector3 at = depth * (ray.x * unit_x + ray.y * unit_y + unit_z) - unit_center;
  const double radius = 0.5 * (half_axes[0] + half_axes[1]);
  return {radius * std::atan2(at[1], at[0]), half_axes[2] * at[2]};
}

RayBounds ViewedEllipsoid::Bounds() const {
  return BoxBounds(center[0], center[2], std::max(half_axes[0], half_axes[1]),
                   center[1] - half_axes[2], center[1] + half_axes[2]);
}

Vector2 ViewedGround::Texture(const Ray& ray, double depth) const {
  const Vector3 point = camera.ToWorld(depth * Vector3(ray.x, ray.y, 1));
  return {point[0], point[1]};
}

double ViewedSkyline::Depth(const Ray& ray) const {
  const double slope = -ray.y / std::sqrt(1 + ray.x * ray.x);
  if (slope < 0 || slope > kHighestSkyline) {
    return kNothing;
  }
  const Vector3 direction = camera.TurnedBack({ray.x, 0, 1});
  const double azimuth = std::atan2(direction[1], direction[0]);
  return slope <= SkylineSlope(azimuth + phase) ? kFarAway : kNothing;
}

Vector2 ViewedSkyline::Texture(const Ray& ray, double /*depth*/) const {
  const Vector3 direction = camera.TurnedBack({ray.x, 0, 1});
  // Texture coordinates as at a distance of 100 m.
  return {100 * std::atan2(direction[1], direction[0]),
          -100 * ray.y / std::sqrt(1 + ray.x * ray.x)};
}

RayBounds ViewedSkyline::Bounds() const {
  return {{-kFarAway, -2 * kHighestSkyline}, {kFarAway, 0}};
}

ViewedShape Seen(const Shape& shape, const CameraPose& camera) {
  return std::visit(
      [&](const auto& s) -> ViewedShape {
        using S = std::decay_t<decltype(s)>;
        if constexpr (std::is_same_v<S, Parallelogram>) {
          return ViewedParallelogram(s, camera);
        } else if constexpr (std::is_same_v<S, Cylinder>) {
          return ViewedCylinder(s, camera);
        } else if constexpr (std::is_same_v<S, Ellipsoid>) {
          return ViewedEllipsoid(s, camera);
        } else if constexpr (std::is_same_v<S, Ground>) {
          return ViewedGround(s, camera);
        } else {
          return ViewedSkyline(s, camera);
        }
      },
      shape);
}

}  // namespace homing::client
