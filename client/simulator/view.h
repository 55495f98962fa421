// A scene as one camera sees it: which surface at which depth at each pixel. Source: own design.
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

inline constexpr std::size_t kPixelCount =
    static_cast<std::size_t>(Simulator::kWidth) * static_cast<std::size_t>(Simulator::kHeight);
// Index of no surface: the sky.
inline constexpr std::int16_t kSky = -1;

// Nearest surface of every pixel, row by row.
struct SurfaceMap {
  std::vector<double> depths;
  std::vector<std::int16_t> surfaces;
};

// Refers to the scene, which must outlive it.
class View {
 public:
  View(const Scene& scene, double route_m, const CameraPose& camera);

  const CameraPose& camera() const { return camera_; }
  const std::vector<ViewedSurface>& surfaces() const { return surfaces_; }
  double sky_grey() const { return sky_grey_; }

  // Rays through the centres of all pixels.
  SurfaceMap Cast() const;
  // Depth of the nearest surface on a ray; kNothing: sky.
  double NearestDepth(const Ray& ray) const;

 private:
  void Add(const Surface& surface);

  CameraPose camera_;
  double sky_grey_;
  std::vector<ViewedSurface> surfaces_;
};

double DepthOf(const ViewedSurface& surface, const Ray& ray);

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_VIEW_H_
