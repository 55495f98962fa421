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
PixelBounds BoundsInImage(const ViewedShape& shape) {
  const RayBounds bounds = std::visit([](const auto& s) { return s.Bounds(); }, shape);
  return {PixelsBetween(bounds.low.x, bounds.high.x, Simulator::kCenterX, Simulator::kWidth),
          PixelsBetween(bounds.low.y, bounds.high.y, Simulator::kCenterY, Simulator::kHeight)};
}

template <typename ShapeSeen>
void CastShape(const ShapeSeen& shape, const PixelBounds& bounds, std::int16_t index,
               SurfaceMap& map) {
  for (int y = bounds.rows.low; y < bounds.rows.high; ++y) {
    const auto row = static_cast<std::size_t>(y) * Simulator::kWidth;
    for (int x = bounds.columns.low; x < bounds.columns.high; ++x) {
      const double depth = shape.Depth(RayAt(x, y));
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

View::View(const Scene& scene, double route_m, const CameraPose& camera)
    : camera_(camera), sky_grey_(scene.sky_grey()) {
  for (const Surface& surface : scene.Near(route_m)) {
    Add(surface);
  }
  Add(scene.ground());
  Add(scene.skyline());
}

void View::Add(const Surface& surface) {
  ViewedShape shape = Seen(surface.shape, camera_);
  if (!BoundsInImage(shape).empty()) {
    surfaces_.push_back({shape, &surface.material, surface.landmark});
  }
}

SurfaceMap View::Cast() const {
  SurfaceMap map{std::vector<double>(kPixelCount, kNothing),
                 std::vector<std::int16_t>(kPixelCount, kSky)};
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const PixelBounds bounds = BoundsInImage(surfaces_[i].shape);
    std::visit(
        [&](const auto& shape) { CastShape(shape, bounds, static_cast<std::int16_t>(i), map); },
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
