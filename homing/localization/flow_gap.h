// Notices that the robot moved further between two observations than the tracker can follow: most
// frames between them were lost.
#ifndef HOMING_LOCALIZATION_FLOW_GAP_H_
#define HOMING_LOCALIZATION_FLOW_GAP_H_

#include <array>
#include <optional>

#include "homing/profile/profile_views.h"

namespace homing {

// The vectors that are left after such a gap match unlike corners by chance, and their length says
// nothing of the distance. There are few of them, and the two sides seldom move the ways that they
// moved before. One camera shows no gaps: it loses vectors in turns too. Not thread-safe.
class FlowGap {
 public:
  // Processes one observation. True: it follows a gap.
  bool Update(const SeenProfiles& profiles);

 private:
  // Each side's image moves to the right.
  using Ways = std::array<bool, 2>;
  static Ways WaysOf(const SeenProfiles& profiles);

  // Number of vectors lately, by side.
  std::array<double, 2> usual_{};
  // Of the last observation without a gap, from the first one on.
  std::optional<Ways> ways_;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_FLOW_GAP_H_
