// The surfaces of the simulated world, and their images in one camera: spheres,
// towers, parallelograms and hills as in the paper (III, Figs 3 to 7).
#ifndef CLIENT_SIMULATOR_SHAPE_H_
#define CLIENT_SIMULATOR_SHAPE_H_

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <variant>
#include <vector>

#include "client/simulator/geometry.h"

namespace homing::client {

// A parallelogram: corner + a * edge_u + b * edge_v, a and b in [0, 1]. Seen from both sides.
struct Parallelogram {
  Vector3 corner;
  Vector3 edge_u;
  Vector3 edge_v;
};

// Upright, without caps: top and bottom are not visible from its side.
struct Cylinder {
  Vector2 center;
  double radius = 1;
  double bottom = 0;
  double top = 1;
};

// A sphere if the half axes are equal, a hill if its centre is at ground level. `heading` turns the
// first half axis; texture is wrapped round the upright axis, its seam away from `heading`.
struct Ellipsoid {
  Vector3 center;
  Vector3 half_axes;
  double heading = 0;
};

// z = 0 everywhere.
struct Ground {};

// A ragged band above the horizon, infinitely far away.
struct Skyline {
  double seed_phase = 0;
};

using Shape = std::variant<Parallelogram, Cylinder, Ellipsoid, Ground, Skyline>;

// Rays of the image that may meet a surface; empty if low > high.
struct RayBounds {
  Ray low{1, 1};
  Ray high{-1, -1};
};

// Each viewed shape: Depth is the distance along the camera's axis (kNothing: missed), Texture the
// place on the surface in metres at a ray that hits at `depth`.
struct ViewedParallelogram {
  ViewedParallelogram(const Parallelogram& shape, const CameraPose& camera);
  double Depth(const Ray& ray) const {
    const double share = 1 / (normal[0] * ray.x + normal[1] * ray.y + normal[2]);
    const double a = (row_u[0] * ray.x + row_u[1] * ray.y + row_u[2]) * share;
    const double b = (row_v[0] * ray.x + row_v[1] * ray.y + row_v[2]) * share;
    const bool inside = a >= 0 && a <= 1 && b >= 0 && b <= 1;
    return inside ? depth_times_divisor * share : kNothing;
  }
  Vector2 Texture(const Ray& ray, double depth) const;
  RayBounds Bounds() const;

  Vector3 corner, edge_u, edge_v;
  Vector3 normal, row_u, row_v;
  double depth_times_divisor;
};

struct ViewedCylinder {
  ViewedCylinder(const Cylinder& shape, const CameraPose& camera);
  double Depth(const Ray& ray) const {
    const double a = ray.x * ray.x + 1;
    const double b = ray.x * center_x + center_z;
    const double discriminant = b * b - a * margin;
    if (discriminant < 0) {
      return kNothing;
    }
    const double depth = (b - std::sqrt(discriminant)) / a;
    const double y = depth * ray.y;
    return y >= top_y && y <= bottom_y ? depth : kNothing;
  }
  Vector2 Texture(const Ray& ray, double depth) const;
  RayBounds Bounds() const;

  double center_x, center_z, radius, top_y, bottom_y;
  double margin;
  CameraPose camera;
};

struct ViewedEllipsoid {
  ViewedEllipsoid(const Ellipsoid& shape, const CameraPose& camera);
  double Depth(const Ray& ray) const {
    const Vector3 along = ray.x * unit_x + ray.y * unit_y + unit_z;
    const double a = along.dot(along);
    const double b = along.dot(unit_center);
    const double discriminant = b * b - a * margin;
    return discriminant < 0 ? kNothing : (b - std::sqrt(discriminant)) / a;
  }
  Vector2 Texture(const Ray& ray, double depth) const;
  RayBounds Bounds() const;

  // Camera axes and centre where the ellipsoid is the unit sphere.
  Vector3 unit_x, unit_y, unit_z, unit_center;
  double margin;
  Vector3 center;
  Vector3 half_axes;
};

struct ViewedGround {
  ViewedGround(const Ground&, const CameraPose& pose) : camera(pose) {}
  double Depth(const Ray& ray) const { return ray.y > 1e-6 ? camera.origin[2] / ray.y : kNothing; }
  Vector2 Texture(const Ray& ray, double depth) const;
  static RayBounds Bounds() { return {{-kFarAway, 0}, {kFarAway, kFarAway}}; }

  CameraPose camera;
};

struct ViewedSkyline {
  ViewedSkyline(const Skyline& skyline, const CameraPose& pose)
      : phase(skyline.seed_phase), camera(pose) {}
  double Depth(const Ray& ray) const;
  Vector2 Texture(const Ray& ray, double depth) const;
  RayBounds Bounds() const;

  double phase;
  CameraPose camera;
};

using ViewedShape =
    std::variant<ViewedParallelogram, ViewedCylinder, ViewedEllipsoid, ViewedGround, ViewedSkyline>;
ViewedShape Seen(const Shape& shape, const CameraPose& camera);

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_SHAPE_H_
