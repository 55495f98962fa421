// What a robot sees as flow vectors that are projected, not tracked: the corners of the world's
// textures with what a tracker adds, a hundred times as fast as images.
#ifndef TESTS_DRIVE_PROJECTED_EYES_H_
#define TESTS_DRIVE_PROJECTED_EYES_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "client/drive/robot_eyes.h"

namespace homing::client {

struct ProjectedEyesOptions {
  // Share of the corners that is not found at an instant: at full light, and more the darker it is.
  double missing = 0.25;
  // Deviation of either end of a vector, pixels; grows as the light falls.
  double noise_px = 0.15;
  // Vectors that are of no corner, a share.
  double clutter = 0.04;
  double light = 1;
  std::uint64_t seed = 1;
};

// The cameras must outlive it.
class ProjectedEyes final : public RobotEyes {
 public:
  ProjectedEyes(const PosedCameras* cameras, const ProjectedEyesOptions& options);

  // The flow since the last observation that moved enough (ObservationFlow); that of the first one
  // is empty.
  Observation See(const Pose& robot, std::int64_t frame) override;

 private:
  struct Corner {
    Vector3 place;
    double route_m = 0;
  };

  void AddCorners(const Surface& surface);
  void AddGround();
  FlowField Field(const Pose& from, const Pose& to, std::int64_t frame, Side camera) const;

  const PosedCameras* cameras_;
  ProjectedEyesOptions options_;
  // In order of route_m.
  std::vector<Corner> corners_;
  std::optional<Pose> reference_;
};

}  // namespace homing::client

#endif  // TESTS_DRIVE_PROJECTED_EYES_H_
