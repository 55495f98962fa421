#include "client/simulator/scene.h"

#include <algorithm>
#include <utility>

namespace homing::client {

Scene::Scene(std::vector<Surface> surfaces, const Material& ground, const Material& skyline,
             double sky_grey)
    : surfaces_(std::move(surfaces)),
      ground_{Ground{}, ground},
      skyline_{Skyline{}, skyline},
      sky_grey_(sky_grey) {
  std::stable_sort(surfaces_.begin(), surfaces_.end(),
                   [](const Surface& a, const Surface& b) { return a.route_m < b.route_m; });
}

std::span<const Surface> Scene::Near(double route_m) const {
  const auto before = [](const Surface& surface, double at) { return surface.route_m < at; };
  const auto first =
      std::lower_bound(surfaces_.begin(), surfaces_.end(), route_m - kReachM, before);
  const auto last = std::lower_bound(first, surfaces_.end(), route_m + kReachM, before);
  return {first, last};
}

std::vector<Parallelogram> BoxWalls(const Pose& frame, const BoxSize& size) {
  const double l = size.length_m / 2;
  const double d = size.depth_m / 2;
  const Vector3 up(0, 0, size.height_m);
  const auto wall = [&](double u0, double v0, double u1, double v1) {
    const Vector3 from = Raise(frame.At(u0, v0), 0);
    return Parallelogram{from, Raise(frame.At(u1, v1), 0) - from, up};
  };
  return {wall(-l, -d, l, -d), wall(l, -d, l, d), wall(l, d, -l, d), wall(-l, d, -l, -d),
          Parallelogram{Raise(frame.At(-l, -d), size.height_m), Raise(2 * l * frame.Along(), 0),
                        Raise(2 * d * frame.Left(), 0)}};
}

}  // namespace homing::client
