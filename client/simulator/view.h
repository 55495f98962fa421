// A scene as one camera sees it: which surface at which depth at each pixel.
#ifndef CLIENT_SIMULATOR_VIEW_H_
#define CLIENT_SIMULATOR_VIEW_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "client/simulator/scene.h"
#include "client/simulator/shape.h"
#include "client/simulator/simulator.h"

namespace homing::client {

struct ViewedSurface {
  ViewedShape shape;
  const Material* material;
  int landmark;
};

// Pixels, x right and y down; the centre of the first pixel is (0, 0).
inline Ray RayAt(double x, double y) {
  constexpr double kPerPixel = 1 / Simulator::kFocal;
  return {(x - Simulator::kCenterX) * kPerPixel, (y - Simulator::kCenterY) * kPerPixel};
}

// How a camera pitches and rolls, radians: about its X axis, then about its Z axis.
struct Tilt {
  double pitch = 0;
  double roll = 0;
};

// Rays of a tilted camera in the coordinates of the upright one, which shapes are viewed in.
// Immutable.
class PixelRays {
 public:
  explicit PixelRays(const Tilt& tilt);

  Ray At(double x, double y) const {
    const Ray ray = RayAt(x, y);
    return is_tilted_ ? Turned(tilt_, ray) : ray;
  }
  // A ray of the upright camera in the coordinates of the tilted one: the reverse of At.
  Ray Untilted(const Ray& ray) const { return is_tilted_ ? Turned(tilt_.t(), ray) : ray; }
  bool is_tilted() const { return is_tilted_; }

 private:
  static Ray Turned(const cv::Matx33d& turn, const Ray& ray) {
    const Vector3 turned = turn * Vector3(ray.x, ray.y, 1);
    return {turned[0] / turned[2], turned[1] / turned[2]};
  }

  bool is_tilted_;
  cv::Matx33d tilt_;
};

inline constexpr std::size_t kPixelCount =
    static_cast<std::size_t>(Simulator::kWidth) * static_cast<std::size_t>(Simulator::kHeight);
// Index of no surface: the sky.
inline constexpr std::int16_t kSky = -1;

// Nearest surface of every pixel, row by row.
struct SurfaceMap {
  std::vector<double> depths;
  std::vector<std::int16_t> surfaces;
};

// Refers to the scene, which must outlive it. Immutable.
class View {
 public:
  View(const Scene& scene, double route_m, const CameraPose& camera, const Tilt& tilt = {});

  // Upright.
  const CameraPose& camera() const { return camera_; }
  const PixelRays& rays() const { return rays_; }
  const std::vector<ViewedSurface>& surfaces() const { return surfaces_; }
  double sky_grey() const { return sky_grey_; }

  // Rays through the centres of all pixels.
  SurfaceMap Cast() const;
  // Depth of the nearest surface on a ray; kNothing: sky.
  double NearestDepth(const Ray& ray) const;

 private:
  void Add(const Surface& surface);

  CameraPose camera_;
  PixelRays rays_;
  double sky_grey_;
  std::vector<ViewedSurface> surfaces_;
};

double DepthOf(const ViewedSurface& surface, const Ray& ray);

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_VIEW_H_
