// Notices that the robot moved further between two observations than the tracker can follow: most
// frames between them were lost.
#ifndef HOMING_LOCALIZATION_FLOW_GAP_H_
#define HOMING_LOCALIZATION_FLOW_GAP_H_

#include <array>

#include "homing/profile/profile_views.h"

namespace homing {

// The vectors that are left after such a gap match unlike corners by chance, and their length says
// nothing of the distance. There are few of them, and the two sides do not move against each other
// as they did before. One camera shows no gaps: it loses vectors in turns too. Not thread-safe.
class FlowGap {
 public:
  // Processes one observation. True: it follows a gap.
  bool Update(const SeenProfiles& profiles);

 private:
  // The sides move against each other, the same way as before.
  bool IsCoherent(const SeenProfiles& profiles) const;

  // Number of vectors lately, by side.
  std::array<double, 2> usual_{};
  // Of the last observation without a gap: right minus left sideways flow is positive. It is known
  // from the first one on.
  bool is_known_ = false;
  bool is_positive_ = false;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_FLOW_GAP_H_
