#include "client/simulator/posed_cameras.h"

#include <utility>

#include "client/simulator/renderer.h"
#include "client/simulator/scene_simulator.h"
#include "client/simulator/simulation_spec.h"
#include "client/simulator/true_flow.h"
#include "client/simulator/view.h"
#include "client/simulator/worlds.h"
#include "homing/base/status_macros.h"

namespace homing::client {

absl::StatusOr<std::unique_ptr<PosedCameras>> PosedCameras::Create(const SimulationSpec& spec) {
  HOMING_RETURN_IF_ERROR(Validate(spec));
  Route route = MakeRoute(spec);
  Scene scene = MakeScene(spec, route);
  const Sensor sensor{spec.light, spec.noise, DriveSeed(spec)};
  return std::unique_ptr<PosedCameras>(
      new PosedCameras(std::move(route), std::move(scene), sensor));
}

PosedCameras::PosedCameras(Route route, Scene scene, const Sensor& sensor)
    : route_(std::move(route)), scene_(std::move(scene)), sensor_(sensor) {}

View PosedCameras::ViewAt(const Pose& robot, Side camera) const {
  return {scene_, route_.Nearest(robot.position), LookAside(robot, kCameraHeightM, camera)};
}

cv::Mat PosedCameras::Render(const Pose& robot, std::int64_t frame, Side camera) const {
  const View view = ViewAt(robot, camera);
  return sensor_.Expose(RenderBrightness(view, view.Cast()), frame, camera);
}

cv::Mat PosedCameras::TrueFlow(const Pose& from, const Pose& to, Side camera) const {
  return FlowBetween(ViewAt(from, camera), ViewAt(to, camera));
}

}  // namespace homing::client
