// A simulator of any scene along any route.
#ifndef CLIENT_SIMULATOR_SCENE_SIMULATOR_H_
#define CLIENT_SIMULATOR_SCENE_SIMULATOR_H_

#include "client/simulator/frame_schedule.h"
#include "client/simulator/route.h"
#include "client/simulator/scene.h"
#include "client/simulator/sensor.h"
#include "client/simulator/simulator.h"
#include "client/simulator/trajectory.h"
#include "client/simulator/view.h"

namespace homing::client {

// Height of the cameras over the ground, m.
inline constexpr double kCameraHeightM = 1;

// Immutable.
class SceneSimulator final : public Simulator {
 public:
  // The spec must be valid; its scene, seed and remove are what `scene` was made with.
  SceneSimulator(const SimulationSpec& spec, Route route, Scene scene,
                 double camera_height_m = kCameraHeightM);

  std::int64_t frame_count() const override { return schedule_.frame_count(); }
  SimulatedInstant Render(std::int64_t index) const override;
  cv::Mat RenderCamera(std::int64_t index, Side camera) const override;
  double RouteMetres(std::int64_t index) const override {
    return trajectory_.RouteMetres(schedule_.TakenAt(index));
  }
  double TimeS(std::int64_t index) const override {
    return trajectory_.TimeS(schedule_.TakenAt(index));
  }
  cv::Mat TrueFlow(std::int64_t index, Side camera) const override;

 private:
  // The view of a frame that the camera takes; not all of them arrive.
  View ViewAt(std::int64_t taken, Side camera) const;
  cv::Mat Image(const View& view, const SurfaceMap& map, std::int64_t taken, Side camera) const;

  SimulationSpec spec_;
  Route route_;
  Scene scene_;
  double camera_height_m_;
  Trajectory trajectory_;
  FrameSchedule schedule_;
  Sensor sensor_;
};

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_SCENE_SIMULATOR_H_
