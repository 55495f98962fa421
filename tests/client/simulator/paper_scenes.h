// The scenes of the paper's experiments (IV, Figs 3 to 7): few textured landmarks to the left of a
// straight route before a plain background, nothing to the right. The
// paper does not give sizes and textures.
#ifndef TESTS_CLIENT_SIMULATOR_PAPER_SCENES_H_
#define TESTS_CLIENT_SIMULATOR_PAPER_SCENES_H_

#include <cstdint>
#include <memory>

#include "client/simulator/scene.h"
#include "client/simulator/simulator.h"

namespace homing::client {

// The sphere-like landmark of Fig. 3, abeam at the start of the route, its centre at the height of
// the camera.
Scene ReferenceScene(double distance_m);
// Fig. 6(a): abeam; it stands on the ground and rises far over the camera.
Scene TowerScene(double distance_m);
// Fig. 6(b): abeam, its centre at the height of the camera.
Scene ParallelogramScene(double distance_m);
// Fig. 7(a): a sphere a little behind the start, a tower 6 m behind the sphere a little ahead, the
// centres of both at the height of the camera.
Scene SphereAndTowerScene(double sphere_distance_m);
// Fig. 7(b): a hill and another tower, 6 m behind the hill, about where sphere and tower were.
Scene HillAndTowerScene(double hill_distance_m);

// A drive past it: frame k is at k / kPaperFps s, the route starts abeam of the landmark.
// `drive_seed` > 0. INVALID_ARGUMENT: speed.
absl::StatusOr<std::unique_ptr<Simulator>> DrivePast(Scene scene, double speed_kmh,
                                                     std::uint64_t drive_seed);

inline constexpr double kPaperFps = 10;

}  // namespace homing::client

#endif  // TESTS_CLIENT_SIMULATOR_PAPER_SCENES_H_
