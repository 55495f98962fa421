// The observations of a simulated robot.
#ifndef CLIENT_DRIVE_ROBOT_EYES_H_
#define CLIENT_DRIVE_ROBOT_EYES_H_

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

#include "client/simulator/posed_cameras.h"
#include "homing/flow/observation.h"

namespace homing::client {

// Not thread-safe.
class RobotEyes {
 public:
  virtual ~RobotEyes() = default;
  // The observation at a pose; its views live until the next call. `frame` numbers the noise.
  virtual Observation See(const Pose& robot, std::int64_t frame) = 0;
};

// Rendered images. The cameras must outlive it.
class RenderedEyes final : public RobotEyes {
 public:
  explicit RenderedEyes(const PosedCameras* cameras) : cameras_(cameras) {}
  Observation See(const Pose& robot, std::int64_t frame) override;

 private:
  const PosedCameras* cameras_;
  std::array<cv::Mat, 2> images_;
};

}  // namespace homing::client

#endif  // CLIENT_DRIVE_ROBOT_EYES_H_
