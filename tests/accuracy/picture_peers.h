// What Homing is compared with: methods that keep pictures. Written for the comparison from what
// was published; causal, as Homing is.
#ifndef TESTS_ACCURACY_PICTURE_PEERS_H_
#define TESTS_ACCURACY_PICTURE_PEERS_H_

#include <vector>

#include "tests/accuracy/run.h"

namespace homing::accuracy {

// Rows: steps of the query; columns: steps of the map.
using Differences = std::vector<std::vector<float>>;

// Mean absolute difference of the pictures, 64 x 32, each normalised in patches of 8 x 8 (mean 0,
// deviation 1), over the cameras that look to the same side of the route. Source: M. Milford,
// G. Wyeth: SeqSLAM, ICRA 2012, III-A.
Differences DifferencesOf(const Run& run);

// SeqSLAM: differences enhanced along the route within 10 places (III-B), summed along straight
// lines through the last `window` instants (III-C), forth and back, speeds 0.5 to 2. The score is
// how much better the best line is than the best one 10 or more places away (as in OpenSeqSLAM).
Answers SeqSlam(const Run& run, const Differences& differences, int window);

// Homing's own filter with pictures instead of flow profiles: the same belief, the odometer that
// the flow gives, and the same evidence of distances and of motion. It is never off the route.
Answers PictureFilter(const Run& run, const Differences& differences);

inline constexpr double kPictureBytes = 2048;

}  // namespace homing::accuracy

#endif  // TESTS_ACCURACY_PICTURE_PEERS_H_
