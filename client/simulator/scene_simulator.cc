#include "client/simulator/scene_simulator.h"

#include <algorithm>
#include <map>
#include <utility>

#include "client/simulator/renderer.h"
#include "client/simulator/simulation_spec.h"
#include "client/simulator/true_flow.h"
#include "client/simulator/worlds.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

// The landmark with the most pixels; of equal ones the lower number.
CameraTruth TruthOf(const View& view, const SurfaceMap& map) {
  std::vector<int> surface_pixels(view.surfaces().size(), 0);
  for (const std::int16_t surface : map.surfaces) {
    if (surface != kSky) {
      ++surface_pixels[static_cast<std::size_t>(surface)];
    }
  }
  std::map<int, int> pixels;
  for (std::size_t i = 0; i < surface_pixels.size(); ++i) {
    pixels[view.surfaces()[i].landmark] += surface_pixels[i];
  }
  pixels.erase(-1);
  const auto most =
      std::max_element(pixels.begin(), pixels.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return {most == pixels.end() || most->second == 0 ? -1 : most->first};
}

}  // namespace

SceneSimulator::SceneSimulator(const SimulationSpec& spec, Route route, Scene scene,
                               double camera_height_m)
    : spec_(spec),
      route_(std::move(route)),
      scene_(std::move(scene)),
      camera_height_m_(camera_height_m),
      trajectory_(spec, DriveSeed(spec)),
      schedule_(spec, trajectory_.frame_count()),
      sensor_{spec.light, spec.noise, DriveSeed(spec)} {}

View SceneSimulator::ViewAt(std::int64_t taken, Side camera) const {
  const bool looks_left = (camera == Side::kLeft) != spec_.travel_return;
  const Side side = looks_left ? Side::kLeft : Side::kRight;
  const Pose pose = trajectory_.At(taken, route_);
  const Trajectory::Jolt jolt = trajectory_.JoltAt(taken);
  CameraPose upright = LookAside(pose, camera_height_m_ + jolt.height_m, side);
  if (spec_.yaw_deg != 0) {
    upright = TurnedClockwise(upright, spec_.yaw_deg * kDegree);
  }
  const Vector3 axis = Raise(jolt.roll * pose.Along() + jolt.pitch * pose.Left(), 0);
  return {scene_, trajectory_.RouteMetres(taken), upright,
          Tilt{axis.dot(upright.right), axis.dot(upright.forward)}};
}

cv::Mat SceneSimulator::Image(const View& view, const SurfaceMap& map, std::int64_t taken,
                              Side camera) const {
  return sensor_.Expose(RenderBrightness(view, map), taken, camera);
}

SimulatedInstant SceneSimulator::Render(std::int64_t index) const {
  const std::int64_t taken = schedule_.TakenAt(index);
  SimulatedInstant instant;
  instant.time_s = trajectory_.TimeS(taken);
  instant.route_m = trajectory_.RouteMetres(taken);
  for (const Side camera : {Side::kLeft, Side::kRight}) {
    if (schedule_.IsAbsent(taken, camera)) {
      continue;
    }
    const View view = ViewAt(taken, camera);
    const SurfaceMap map = view.Cast();
    const auto i = static_cast<std::size_t>(camera);
    instant.images[i] = Image(view, map, taken, camera);
    instant.truth[i] = TruthOf(view, map);
  }
  return instant;
}

cv::Mat SceneSimulator::RenderCamera(std::int64_t index, Side camera) const {
  const std::int64_t taken = schedule_.TakenAt(index);
  if (schedule_.IsAbsent(taken, camera)) {
    return {};
  }
  const View view = ViewAt(taken, camera);
  return Image(view, view.Cast(), taken, camera);
}

cv::Mat SceneSimulator::TrueFlow(std::int64_t index, Side camera) const {
  return FlowBetween(ViewAt(schedule_.TakenAt(index), camera),
                     ViewAt(schedule_.TakenAt(index + 1), camera));
}

Route MakeRoute(const SimulationSpec& spec) {
  RouteBend bend = BendOf(spec.seed);
  bend.corner_rad = spec.corner_deg * kDegree;
  bend.corners_m = {spec.length_m / 3, 2 * spec.length_m / 3};
  return {spec.length_m + spec.extra_m, bend};
}

Scene MakeScene(const SimulationSpec& spec, const Route& route) {
  return spec.scene == "street" ? MakeStreetScene(route, spec.seed, spec.remove)
                                : MakeLandmarkScene(route, spec.seed, spec.remove);
}

absl::StatusOr<std::unique_ptr<Simulator>> Simulator::Create(const SimulationSpec& spec) {
  HOMING_RETURN_IF_ERROR(Validate(spec));
  Route route = MakeRoute(spec);
  Scene scene = MakeScene(spec, route);
  return std::make_unique<SceneSimulator>(spec, std::move(route), std::move(scene));
}

}  // namespace homing::client
