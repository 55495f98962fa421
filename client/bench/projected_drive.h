// Drives whose flow is projected from points instead of rendered: long routes at little cost.
#ifndef CLIENT_BENCH_PROJECTED_DRIVE_H_
#define CLIENT_BENCH_PROJECTED_DRIVE_H_

#include <array>
#include <cstdint>
#include <vector>

#include "homing/flow/observation.h"
#include "homing/matching/matcher.h"

namespace homing::client {

// Both sides of a street: façades with corners, posts before them, far objects behind. All routes
// take their façades from one pool of eight patterns of corners. Immutable.
class ProjectedWorld {
 public:
  ProjectedWorld(std::uint64_t seed, double length_m);

  struct Corner {
    // Metres: along the route, from its middle, above the camera.
    float along = 0;
    float away = 0;
    float up = 0;
    // The object that holds the point; all points of an object disappear together. Negative: a
    // façade, which never disappears.
    std::int32_t object = -1;
  };

  // By side of the route, home first.
  const std::vector<Corner>& corners(std::size_t side) const { return corners_[side]; }

 private:
  void AddFront(std::size_t side, double begin, double end, std::uint64_t key);
  void AddRest(std::size_t side, double length_m, std::uint64_t key);

  std::array<std::vector<Corner>, 2> corners_;
  std::int32_t objects_ = 0;
};

struct ProjectedDriveOptions {
  // The seed of noise, clutter and missing objects; each drive has its own.
  std::uint64_t seed = 1;
  double start_m = 0;
  double end_m = 0;
  double speed_kmh = 4;
  double fps = 5;
  // Offset to the left of the outbound path, metres.
  double offset_m = 0;
  Travel travel = Travel::kSame;
  // Noise of either end of a vector, pixels.
  double noise_px = 0.2;
  // Fractions: of corners that are not found at an instant; of vectors that belong to no corner; of
  // posts, boxes and trees that have disappeared.
  double missing = 0.2;
  double clutter = 0.15;
  double removed = 0.1;
};

// Equal options give equal instants. Cameras of 320 x 240, focal length 277 px. Immutable.
class ProjectedDrive {
 public:
  ProjectedDrive(const ProjectedWorld* world, const ProjectedDriveOptions& options);

  std::int64_t size() const { return size_; }
  ObservedFlow Flow(std::int64_t instant) const;
  // Position along the route at the middle of the instant, metres.
  double Place(std::int64_t instant) const;

 private:
  bool IsGone(const ProjectedWorld::Corner& corner) const;
  FlowField Field(std::size_t side, std::int64_t instant) const;

  const ProjectedWorld* world_;
  ProjectedDriveOptions options_;
  double step_m_ = 0;
  std::int64_t size_ = 0;
};

}  // namespace homing::client

#endif  // CLIENT_BENCH_PROJECTED_DRIVE_H_
