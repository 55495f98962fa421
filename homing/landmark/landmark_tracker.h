// Counts landmarks along a journey: the landmark seen at one step and the one seen at the next are
// the same while its mean moves as the flow says. Source: paper III (counting of landmarks).
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
// number of landmarks so far, all of which are durable: a recording resumes exactly.
class LandmarkTracker {
 public:
  // REQUIRES: Validate(options).ok().
  explicit LandmarkTracker(const LandmarkOptions& options);

  // Numbers the landmarks seen at `step` on `side`; call once a side and step, steps increasing,
  // left before right. One to one: nearest pair first.
  std::vector<Fingerprint> Count(std::int64_t step, Side side,
                                 const std::vector<SeenLandmark>& seen);

  // Takes a stored fingerprint back into the state; call in order of step.
  void Restore(std::int64_t step, Side side, const Fingerprint& fingerprint);

  // Landmarks counted so far; the next new one gets this number.
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
