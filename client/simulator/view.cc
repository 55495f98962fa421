#include "client/simulator/view.h"

#include <algorithm>
#include <cmath>

namespace homing::client {
namespace {

// Pixels [low, high) whose centres lie between two rays of one axis.
struct PixelRange {
  int low;
  int high;
};
PixelRange PixelsBetween(double low, double high, double center, int size) {
  const double first = std::ceil(low * Simulator::kFocal + center);
  const double last = std::floor(high * Simulator::kFocal + center);
  return {static_cast<int>(std::clamp<double>(first, 0, size)),
          static_cast<int>(std::clamp<double>(last + 1, 0, size))};
}

struct PixelBounds {
  PixelRange columns;
  PixelRange rows;
  bool empty() const { return columns.low >= columns.high || rows.low >= rows.high; }
};
// The rays of the tilted image that hold these of the upright one.
RayBounds Untilted(const RayBounds& bounds, const PixelRays& rays) {
  if (!rays.is_tilted() || bounds.low.x > bounds.high.x || bounds.low.y > bounds.high.y) {
    return bounds;
  }
  // Rays outside of any image, but still in front of the tilted camera.
  const auto bound = [](double v) { return std::clamp(v, -2.0, 2.0); };
  RayBounds result{{kFarAway, kFarAway}, {-kFarAway, -kFarAway}};
  for (const double x : {bounds.low.x, bounds.high.x}) {
    for (const double y : {bounds.low.y, bounds.high.y}) {
      const Ray ray = rays.Untilted(Ray{bound(x), bound(y)});
      result.low.x = std::min(result.low.x, ray.x);
      result.low.y = std::min(result.low.y, ray.y);
      result.high.x = std::max(result.high.x, ray.x);
      result.high.y = std::max(result.high.y, ray.y);
    }
  }
  return result;
}

PixelBounds BoundsInImage(const ViewedShape& shape, const PixelRays& rays) {
  const RayBounds bounds =
      Untilted(std::visit([](const auto& s) { return s.Bounds(); }, shape), rays);
  return {PixelsBetween(bounds.low.x, bounds.high.x, Simulator::kCenterX, Simulator::kWidth),
          PixelsBetween(bounds.low.y, bounds.high.y, Simulator::kCenterY, Simulator::kHeight)};
}

template <typename ShapeSeen>
void CastShape(const ShapeSeen& shape, const PixelBounds& bounds, const PixelRays& rays,
               std::int16_t index, SurfaceMap& map) {
  for (int y = bounds.rows.low; y < bounds.rows.high; ++y) {
    const auto row = static_cast<std::size_t>(y) * Simulator::kWidth;
    for (int x = bounds.columns.low; x < bounds.columns.high; ++x) {
      const double depth = shape.Depth(rays.At(x, y));
      const std::size_t pixel = row + static_cast<std::size_t>(x);
      if (depth > kNearest && depth < map.depths[pixel]) {
        map.depths[pixel] = depth;
        map.surfaces[pixel] = index;
      }
    }
  }
}

}  // namespace

double DepthOf(const ViewedSurface& surface, const Ray& ray) {
  const double depth = std::visit([&](const auto& s) { return s.Depth(ray); }, surface.shape);
  return depth > kNearest ? depth : kNothing;
}

PixelRays::PixelRays(const Tilt& tilt) : is_tilted_(tilt.pitch != 0 || tilt.roll != 0) {
  const double cp = std::cos(tilt.pitch);
  const double sp = std::sin(tilt.pitch);
  const double cr = std::cos(tilt.roll);
  const double sr = std::sin(tilt.roll);
  const cv::Matx33d pitch(1, 0, 0, 0, cp, -sp, 0, sp, cp);
  const cv::Matx33d roll(cr, -sr, 0, sr, cr, 0, 0, 0, 1);
  tilt_ = pitch * roll;
}

View::View(const Scene& scene, double route_m, const CameraPose& camera, const Tilt& tilt)
    : camera_(camera), rays_(tilt), sky_grey_(scene.sky_grey()) {
  for (const Surface& surface : scene.Near(route_m)) {
    Add(surface);
  }
  Add(scene.ground());
  Add(scene.skyline());
}

void View::Add(const Surface& surface) {
  ViewedShape shape = Seen(surface.shape, camera_);
  if (!BoundsInImage(shape, rays_).empty()) {
    surfaces_.push_back({shape, &surface.material, surface.landmark});
  }
}

SurfaceMap View::Cast() const {
  SurfaceMap map{std::vector<double>(kPixelCount, kNothing),
                 std::vector<std::int16_t>(kPixelCount, kSky)};
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const PixelBounds bounds = BoundsInImage(surfaces_[i].shape, rays_);
    std::visit(
        [&](const auto& shape) {
          CastShape(shape, bounds, rays_, static_cast<std::int16_t>(i), map);
        },
        surfaces_[i].shape);
  }
  return map;
}

double View::NearestDepth(const Ray& ray) const {
  double nearest = kNothing;
  for (const ViewedSurface& surface : surfaces_) {
    nearest = std::min(nearest, DepthOf(surface, ray));
  }
  return nearest;
}

}  // namespace homing::client
