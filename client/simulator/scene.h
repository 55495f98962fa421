// The surfaces along a route and their appearance.
#ifndef CLIENT_SIMULATOR_SCENE_H_
#define CLIENT_SIMULATOR_SCENE_H_

#include <span>
#include <vector>

#include "client/simulator/shape.h"

namespace homing::client {

// Grey value: mean + contrast * texture, the texture in [-1, 1] with deviation 0.5.
struct Material {
  // Index of the texture in the pool, TextureKind.
  int texture = 0;
  // Side of one tile, m.
  double tile_m = 3;
  // Tiles.
  Vector2 offset{0, 0};
  double mean = 120;
  double contrast = 80;
};

struct Surface {
  Shape shape;
  Material material;
  // Number along the route, -1: background.
  int landmark = -1;
  // Place along the route, m.
  double route_m = 0;
};

// Immutable.
class Scene {
 public:
  Scene(std::vector<Surface> surfaces, const Material& ground, const Material& skyline,
        double sky_grey);

  // Surfaces within kReach_m of a place of the route.
  std::span<const Surface> Near(double route_m) const;
  const Surface& ground() const { return ground_; }
  const Surface& skyline() const { return skyline_; }
  double sky_grey() const { return sky_grey_; }
  const std::vector<Surface>& surfaces() const { return surfaces_; }

  // Beyond this distance along the route a camera sees only background.
  static constexpr double kReachM = 60;

 private:
  // Sorted by route_m.
  std::vector<Surface> surfaces_;
  Surface ground_;
  Surface skyline_;
  double sky_grey_;
};

struct BoxSize {
  double length_m;
  double depth_m;
  double height_m;
};

// The four walls and the lid of an upright box on the ground; `frame` is its centre, its first side
// lies along the heading.
std::vector<Parallelogram> BoxWalls(const Pose& frame, const BoxSize& size);

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_SCENE_H_
