// The key of a row of `fingerprints`: journey, step and index within the step in one integer, which
// keeps rows in the order of the journey and saves a quarter of their bytes. The same for a row of
// `profiles`, with the side as index. Source: own design.
#ifndef STORAGE_FINGERPRINT_ID_H_
#define STORAGE_FINGERPRINT_ID_H_

#include <cstdint>

#include "homing/journey/journey_map.h"

namespace homing::storage {

// Bits of index (up to four fingerprints a step) and of step. The schema holds them as well.
inline constexpr int kIndexBits = 2;
inline constexpr int kStepBits = 25;
static_assert(kMostSteps <= std::int64_t{1} << kStepBits);

inline std::int64_t FingerprintId(std::int64_t journey_id, std::int64_t step, int index) {
  return (journey_id << (kStepBits + kIndexBits)) + (step << kIndexBits) + index;
}

inline std::int64_t StepOfFingerprint(std::int64_t fingerprint_id) {
  return (fingerprint_id >> kIndexBits) & ((std::int64_t{1} << kStepBits) - 1);
}

inline std::int64_t IndexOfFingerprint(std::int64_t fingerprint_id) {
  return fingerprint_id & ((std::int64_t{1} << kIndexBits) - 1);
}

}  // namespace homing::storage

#endif  // STORAGE_FINGERPRINT_ID_H_
