// The views of a robot's two cameras at any position and heading in a world.
#ifndef CLIENT_SIMULATOR_POSED_CAMERAS_H_
#define CLIENT_SIMULATOR_POSED_CAMERAS_H_

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>

#include "absl/status/statusor.h"
#include "client/simulator/geometry.h"
#include "client/simulator/route.h"
#include "client/simulator/scene.h"
#include "client/simulator/sensor.h"
#include "client/simulator/simulator.h"

namespace homing::client {

class View;

// Here a pose's heading is where the ROBOT heads. The same spec, pose and frame give the same
// bytes. Thread-compatible: all but Create is const.
class PosedCameras {
 public:
  // The world, light and noise of `spec`; of its drive nothing but the seed. INVALID_ARGUMENT.
  static absl::StatusOr<std::unique_ptr<PosedCameras>> Create(const SimulationSpec& spec);

  // The line that an outbound robot follows without offset and wobble.
  const Route& route() const { return route_; }
  const Scene& scene() const { return scene_; }
  // The view refers to this object.
  View ViewAt(const Pose& robot, Side camera) const;

  // CV_8UC1. `frame` numbers the noise and the exposure.
  cv::Mat Render(const Pose& robot, std::int64_t frame, Side camera) const;
  // As FlowBetween.
  cv::Mat TrueFlow(const Pose& from, const Pose& to, Side camera) const;

 private:
  PosedCameras(Route route, Scene scene, const Sensor& sensor);

  Route route_;
  Scene scene_;
  Sensor sensor_;
};

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_POSED_CAMERAS_H_
