#include "tests/client/simulator/paper_scenes.h"

#include <numbers>
#include <utility>
#include <vector>

#include "client/simulator/scene_simulator.h"
#include "client/simulator/simulation_spec.h"
#include "client/simulator/texture_pool.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

constexpr double kPaperCameraHeightM = 2;
// The tower of Fig. 7 stands this far behind the sphere (11 m and 5 m, 13 m and 7 m).
constexpr double kTowerBehindM = 6;

Material Textured(TextureKind kind, double tile_m) {
  return {.texture = kind, .tile_m = tile_m, .mean = 110, .contrast = 100};
}

Scene BeforePlainBackground(std::vector<Surface> surfaces) {
  const Material plain{.mean = 160, .contrast = 0};
  return {std::move(surfaces), plain, plain, plain.mean};
}

Surface Sphere(double along_m, double distance_m, double radius_m, const Material& material) {
  // The seam of the texture is on the far side.
  const Ellipsoid sphere{{along_m, distance_m, kPaperCameraHeightM},
                         {radius_m, radius_m, radius_m},
                         -std::numbers::pi / 2};
  return {sphere, material, 0};
}

Surface Tower(double along_m, double distance_m, double radius_m, double height_m,
              TextureKind kind) {
  return {Cylinder{{along_m, distance_m}, radius_m, 0, height_m}, Textured(kind, 3), 1};
}

}  // namespace

Scene ReferenceScene(double distance_m) {
  return BeforePlainBackground({Sphere(0, distance_m, 1.8, Textured(kSpots, 4))});
}

Scene TowerScene(double distance_m) {
  return BeforePlainBackground({Tower(0, distance_m, 0.8, 10, kBricks)});
}

Scene ParallelogramScene(double distance_m) {
  const Parallelogram board{
      {-2.0, distance_m, kPaperCameraHeightM - 1.4}, {3.2, 0, 0}, {0.8, 0, 2.8}};
  return BeforePlainBackground({{board, Textured(kTiles, 4), 0}});
}

Scene SphereAndTowerScene(double sphere_distance_m) {
  return BeforePlainBackground(
      {Sphere(-0.4, sphere_distance_m, 0.7, Textured(kMosaic, 3)),
       Tower(2.6, sphere_distance_m + kTowerBehindM, 0.8, 2 * kPaperCameraHeightM, kBricks)});
}

Scene HillAndTowerScene(double hill_distance_m) {
  const Ellipsoid hill{{-0.7, hill_distance_m, 0}, {1.0, 1.0, 1.5}, -std::numbers::pi / 2};
  return BeforePlainBackground({{hill, Textured(kValueNoise, 3), 0},
                                Tower(3.4, hill_distance_m + kTowerBehindM, 0.6, 9, kBands)});
}

absl::StatusOr<std::unique_ptr<Simulator>> DrivePast(Scene scene, double speed_kmh,
                                                     std::uint64_t drive_seed) {
  SimulationSpec spec;
  spec.scene = "landmarks";
  spec.length_m = 5;
  spec.fps = kPaperFps;
  spec.speed_kmh = speed_kmh;
  spec.drive_seed = drive_seed;
  HOMING_RETURN_IF_ERROR(Validate(spec));
  return std::make_unique<SceneSimulator>(spec, Route(spec.length_m, {}), std::move(scene),
                                          kPaperCameraHeightM);
}

}  // namespace homing::client
