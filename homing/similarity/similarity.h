// How alike two fingerprints are: P_T (paper III, eqs 9, 13 to 15).
#ifndef HOMING_SIMILARITY_SIMILARITY_H_
#define HOMING_SIMILARITY_SIMILARITY_H_

#include "homing/landmark/fingerprint.h"
#include "homing/similarity/deviation_model.h"

namespace homing {

// A landmark is recognised from this P_T on (paper V).
inline constexpr double kRecognitionThreshold = 0.20;

// Mean position and number of vectors, on doubles.
struct MeanAndCount {
  double x = 0;
  double y = 0;
  double count = 0;
};

struct Similarity {
  // Distance of the means, pixels (eq 13).
  double delta = 0;
  // 1 - F(delta) (eqs 9, 14).
  double p = 0;
  // P * min(r, s) / max(r, s) (eq 15).
  double p_t = 0;
};

// delta = 0 gives P = 1; a count of zero on either side gives P_T = 0.
Similarity Compare(const MeanAndCount& i, const MeanAndCount& j, const DeviationModel& model);
Similarity Compare(const Fingerprint& i, const Fingerprint& j, const DeviationModel& model);

}  // namespace homing

#endif  // HOMING_SIMILARITY_SIMILARITY_H_
