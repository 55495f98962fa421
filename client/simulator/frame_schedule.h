// Determines which of the cameras' frames arrive: some are lost, some come twice.
#ifndef CLIENT_SIMULATOR_FRAME_SCHEDULE_H_
#define CLIENT_SIMULATOR_FRAME_SCHEDULE_H_

#include <cstdint>
#include <vector>

#include "client/simulator/simulator.h"

namespace homing::client {

// The cost does not depend on the length of the drive. Immutable.
class FrameSchedule {
 public:
  // The spec must be valid; `taken` frames are taken on the drive.
  FrameSchedule(const SimulationSpec& spec, std::int64_t taken);

  // Frames that arrive.
  std::int64_t frame_count() const { return frame_count_; }
  // Number, among those taken, of the frame that arrives as number `index`.
  std::int64_t TakenAt(std::int64_t index) const;
  // True if the camera gives no image for this frame.
  bool IsAbsent(std::int64_t taken, Side camera) const;

 private:
  // Frames are lost block by block.
  static constexpr std::int64_t kBlock = 20;

  // Frames of a block that are not lost, from 0, in order.
  std::vector<std::int64_t> KeptIn(std::int64_t block) const;

  std::uint64_t seed_;
  // 0: none is repeated.
  std::int64_t repeat_;
  std::int64_t kept_a_block_;
  // 0: none.
  std::int64_t drop_run_;
  std::int64_t frame_count_;
};

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_FRAME_SCHEDULE_H_
