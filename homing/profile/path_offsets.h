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

// Each stretch of the journey has its own belief: what the robot is taken to see at a wrong place
// fits there under some wrong offset, which must not be expected at the right place too. The
// belief goes where the robot goes, and is forgotten within some dozens of observations. Not
// thread-safe.
class PathOffsets {
 public:
  // Steps of a stretch.
  static constexpr std::int64_t kStretch = 16;

  // Stretches that the first `steps` steps lie in.
  static std::size_t StretchesOf(std::int64_t steps) {
    return static_cast<std::size_t>((steps + kStretch - 1) / kStretch);
  }
  // Before anything was seen.
  static const OffsetValues& Prior();

  // `mass` as shares, of which some is forgotten: the prior, where there is no mass.
  static OffsetValues Mix(const OffsetValues& mass);

  // Takes up stretches at the end.
  void Grow(std::int64_t step_count);
  // Probability of each offset for a robot at a step of this stretch.
  const OffsetValues& of(std::size_t stretch) const { return stretches_[stretch]; }

  // One observation. `fits`: of stretches from `first` on, the mass that was predicted there times
  // how well it fits under each of the offsets that were `tried`; elsewhere the robot is not.
  // Returns the mass that fits, by offset.
  OffsetValues Learn(std::size_t first, std::span<const OffsetValues> fits,
                     const std::array<bool, kPathOffsets.size()>& tried);

 private:
  std::vector<OffsetValues> stretches_;
};

}  // namespace homing

#endif  // HOMING_PROFILE_PATH_OFFSETS_H_
