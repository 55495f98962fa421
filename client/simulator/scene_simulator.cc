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

// Most pixels wins, the lower number if equal.
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
      sensor_{spec.light, spec.noise, DriveSeed(spec)} {}

View SceneSimulator::ViewAt(std::int64_t index, Side camera) const {
  const bool looks_left = (camera == Side::kLeft) != spec_.travel_return;
  const Side side = looks_left ? Side::kLeft : Side::kRight;
  return {scene_, trajectory_.RouteMetres(index),
          LookAside(trajectory_.At(index, route_), camera_height_m_, side)};
}

cv::Mat SceneSimulator::Image(const View& view, const SurfaceMap& map, std::int64_t index,
                              Side camera) const {
  return sensor_.Expose(RenderBrightness(view, map), index, camera);
}

SimulatedInstant SceneSimulator::Render(std::int64_t index) const {
  SimulatedInstant instant;
  instant.time_s = trajectory_.TimeS(index);
  instant.route_m = RouteMetres(index);
  for (const Side camera : {Side::kLeft, Side::kRight}) {
    const View view = ViewAt(index, camera);
    const SurfaceMap map = view.Cast();
    const auto i = static_cast<std::size_t>(camera);
    instant.images[i] = Image(view, map, index, camera);
    instant.truth[i] = TruthOf(view, map);
  }
  return instant;
}

cv::Mat SceneSimulator::RenderCamera(std::int64_t index, Side camera) const {
  const View view = ViewAt(index, camera);
  return Image(view, view.Cast(), index, camera);
}

cv::Mat SceneSimulator::TrueFlow(std::int64_t index, Side camera) const {
  return FlowBetween(ViewAt(index, camera), ViewAt(index + 1, camera));
}

absl::StatusOr<std::unique_ptr<Simulator>> Simulator::Create(const SimulationSpec& spec) {
  HOMING_RETURN_IF_ERROR(Validate(spec));
  Route route(spec.length_m, BendOf(spec.seed));
  Scene scene = spec.scene == "street" ? MakeStreetScene(route, spec.seed, spec.remove)
                                       : MakeLandmarkScene(route, spec.seed, spec.remove);
  return std::make_unique<SceneSimulator>(spec, std::move(route), std::move(scene));
}

}  // namespace homing::client
