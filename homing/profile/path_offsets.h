// How far beside the outbound path the robot drives, if it is at a given place of a journey.
#ifndef HOMING_PROFILE_PATH_OFFSETS_H_
#define HOMING_PROFILE_PATH_OFFSETS_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "homing/profile/profile_views.h"

namespace homing {

// One value for each of kPathOffsets.
using OffsetValues = std::array<double, kPathOffsets.size()>;

// Each stretch of the journey has its own belief, so that an offset learnt at a wrong place does
// not bias the right one. The belief moves with the robot, and is forgotten within some dozens of
// observations. Not thread-safe.
class PathOffsets {
 public:
  // Steps of a stretch.
  static constexpr std::int64_t kStretch = 16;

  // Stretches that the first `steps` steps lie in.
  static std::size_t StretchesOf(std::int64_t steps) {
    return static_cast<std::size_t>((steps + kStretch - 1) / kStretch);
  }
  // The belief before the first observation.
  static const OffsetValues& Prior();

  // `mass` normalised and mixed with a little of the prior (forgetting); the prior if there is no
  // mass.
  static OffsetValues Mix(const OffsetValues& mass);

  // Appends stretches until they cover `step_count` steps.
  void Grow(std::int64_t step_count);
  // Probability of each offset for a robot at a step of this stretch.
  const OffsetValues& of(std::size_t stretch) const { return stretches_[stretch]; }

  // Processes one observation. `fits`: for each stretch from `first` on and each of the `tried`
  // offsets, the predicted mass times its likelihood; the robot is in no other stretch. Returns the
  // sum over the stretches, by offset.
  OffsetValues Learn(std::size_t first, std::span<const OffsetValues> fits,
                     const std::array<bool, kPathOffsets.size()>& tried);

 private:
  std::vector<OffsetValues> stretches_;
};

}  // namespace homing

#endif  // HOMING_PROFILE_PATH_OFFSETS_H_
