// The simulated robot: two sideways cameras drive a route past textured landmarks, with exact
// ground truth. Follows the paper's simulation (III, IV). Deterministic: same
// spec, same bytes.
#ifndef CLIENT_SIMULATOR_SIMULATOR_H_
#define CLIENT_SIMULATOR_SIMULATOR_H_

#include <array>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "homing/flow/observation.h"

namespace homing::client {

// One drive through a scene. From text: "sim:SCENE[,key=value...]".
struct SimulationSpec {
  // "landmarks" or "street"; tests may build other scenes (scene.h).
  std::string scene = "street";
  // World; the same seed and length is the same route, another seed a foreign one.
  std::uint64_t seed = 1;
  // Route length, m. [1, 100000].
  double length_m = 150;
  // Frames a second. [0.1, 240].
  double fps = 5;
  // Robot's speed, km/h. [0.1, 100].
  double speed_kmh = 4;
  // Metres to the left of the outbound path (seen outbound), whatever the travel. [-5, 5].
  double offset_m = 0;
  // Exposure: image gain. Varied further by +-10 % a frame and camera, by drive. [0.1, 4].
  double light = 1;
  // Sensor noise sigma, grey levels of 255. [2, 100].
  double noise = 2;
  // Fraction of landmarks removed. [0, 1].
  double remove = 0;
  // Amplitude of a slow lateral and yaw wobble, m. [0, 2].
  double wobble_m = 0;
  // Seconds of standing in the middle of the drive. [0, 3600].
  double stop_s = 0;
  // How much the speed varies along the drive, smoothly: at 1 from 0.3 to 2 times `speed`. [0, 1].
  double vary = 0;
  // Metres driven on beyond the end of the route: the far one, on return the home one. [0, 40].
  double extra_m = 0;
  // Cameras turned about the vertical axis, both clockwise seen from above, degrees: at 90 the left
  // one looks ahead and the right one behind. [-180, 180].
  double yaw_deg = 0;
  // Steering: the heading sways by up to this, degrees, and the robot goes where it heads. [0, 20].
  double yaw_wobble_deg = 0;
  // Rough ground: pitch and roll of each frame up to this, degrees, and its height up to as many
  // centimetres. [0, 5].
  double rough_deg = 0;
  // Each n-th frame repeats the previous one, without a pause in the drive; n is this value. 0:
  // none. [2, 1000].
  double repeat = 0;
  // Fraction of the frames of both cameras that are lost, in twentieths. [0, 0.95].
  double drop = 0;
  // Number of frames in a row that one of the cameras loses, once in five times as many frames; 0:
  // none. [1, 1000].
  double drop_run = 0;
  // The route turns by this to the left after a third of its length, and back after two thirds,
  // degrees. [-60, 60].
  double corner_deg = 0;
  // True: from the far end home, heading the other way.
  bool travel_return = false;
  // Seed of noise and light; 0: made from the other keys, so that two drives differ.
  std::uint64_t drive_seed = 0;
};

// INVALID_ARGUMENT naming key, value and limit.
absl::StatusOr<SimulationSpec> ParseSimulationSpec(const std::string& text);

struct CameraTruth {
  // Index of the landmark that covers the most pixels, -1: none.
  int landmark = -1;
};

struct SimulatedInstant {
  double time_s = 0;
  // Along the outbound route from home.
  double route_m = 0;
  // Robot's cameras, indexed by Side. CV_8UC1; empty: the camera gave none.
  std::array<cv::Mat, 2> images;
  std::array<CameraTruth, 2> truth;
};

// Thread-compatible: Render is const.
class Simulator {
 public:
  // INVALID_ARGUMENT.
  static absl::StatusOr<std::unique_ptr<Simulator>> Create(const SimulationSpec& spec);
  virtual ~Simulator() = default;

  virtual std::int64_t frame_count() const = 0;
  // Both cameras at frame `index`. REQUIRES: 0 <= index < frame_count().
  virtual SimulatedInstant Render(std::int64_t index) const = 0;
  // One camera only; empty: it gave no image.
  virtual cv::Mat RenderCamera(std::int64_t index, Side camera) const = 0;
  virtual double RouteMetres(std::int64_t index) const = 0;
  virtual double TimeS(std::int64_t index) const = 0;
  // True flow from frame `index` to the next at every pixel of one camera, CV_32FC2 (NaN where
  // nothing is seen or the point is hidden in the next frame).
  virtual cv::Mat TrueFlow(std::int64_t index, Side camera) const = 0;

  // Cameras: 320x240, focal length 277 px.
  static constexpr int kWidth = 320;
  static constexpr int kHeight = 240;
  static constexpr double kFocal = 277;
  // Principal point; the centre of the first pixel is (0, 0).
  static constexpr double kCenterX = 0.5 * (kWidth - 1);
  static constexpr double kCenterY = 0.5 * (kHeight - 1);
};

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_SIMULATOR_H_
