// The landmarks of a world under construction: numbered along the route, some of them left out.
#ifndef CLIENT_SIMULATOR_LANDMARK_LIST_H_
#define CLIENT_SIMULATOR_LANDMARK_LIST_H_

#include <cstdint>
#include <vector>

#include "client/simulator/scene.h"

namespace homing::client {

struct PlacedLandmark {
  double route_m = 0;
  std::vector<Shape> shapes;
  Material material;
};

// Shapes as a list.
template <typename... Shapes>
std::vector<Shape> ShapesAsList(const Shapes&... shapes) {
  std::vector<Shape> list;
  list.reserve(sizeof...(shapes));
  (list.emplace_back(shapes), ...);
  return list;
}

// A world reaches this far beyond both ends of its route, m.
inline constexpr double kWorldMarginM = 40;

// Surfaces of the landmarks, numbered by their place; each is left out with probability `remove`.
std::vector<Surface> Numbered(std::vector<PlacedLandmark> landmarks, std::uint64_t seed,
                              double remove);

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_LANDMARK_LIST_H_
