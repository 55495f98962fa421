// Numbers landmarks along a journey: a landmark seen at one step and one seen at a later step are
// the same if its mean moved as the flow predicts. Source: paper III (counting of landmarks).
#ifndef HOMING_LANDMARK_LANDMARK_TRACKER_H_
#define HOMING_LANDMARK_LANDMARK_TRACKER_H_

#include <array>
#include <cstdint>
#include <vector>

#include "homing/flow/observation.h"
#include "homing/landmark/fingerprint.h"
#include "homing/landmark/landmark_finder.h"
#include "homing/landmark/landmark_options.h"

namespace homing {

// Its state is a function of the fingerprints of the last max_track_gap_steps + 1 steps and of the
// number of landmarks so far, all of which are durable: a recording resumes exactly. Not
// thread-safe.
class LandmarkTracker {
 public:
  // REQUIRES: Validate(options).ok().
  explicit LandmarkTracker(const LandmarkOptions& options);

  // Gives each landmark seen at `step` on `side` the number of the known landmark it continues,
  // nearest pair first, or the next free number. Call it once a side and step, with increasing
  // steps, left before right.
  std::vector<Fingerprint> Associate(std::int64_t step, Side side,
                                     const std::vector<SeenLandmark>& seen);

  // Adds a stored fingerprint to the state. Call it in order of step.
  void Restore(std::int64_t step, Side side, const Fingerprint& fingerprint);

  // Landmarks numbered so far; the next new one gets this number.
  int landmark_count() const { return next_landmark_; }
  void set_landmark_count(int count) { next_landmark_ = count; }

 private:
  void Forget(std::int64_t step, Side side);

  struct Active {
    std::int64_t step;
    Fingerprint fingerprint;
  };
  LandmarkOptions options_;
  int next_landmark_ = 0;
  std::array<std::vector<Active>, 2> active_;
};

}  // namespace homing

#endif  // HOMING_LANDMARK_LANDMARK_TRACKER_H_
