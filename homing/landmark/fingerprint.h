// The fingerprint: the stored data of a landmark at one step (paper III, eqs 11, 12).
#ifndef HOMING_LANDMARK_FINGERPRINT_H_
#define HOMING_LANDMARK_FINGERPRINT_H_

#include <cstdint>

namespace homing {

// The same 16 bytes in memory, on disk and on the wire. The container knows the
// journey, the step and the side.
struct Fingerprint {
  // Mean midpoint, source pixels.
  float x = 0;
  float y = 0;
  // Number of vectors, > 0.
  std::int32_t count = 0;
  // Number of the landmark along the journey, from 0 in the order met.
  std::int32_t landmark = 0;
  friend bool operator==(const Fingerprint&, const Fingerprint&) = default;
};
static_assert(sizeof(Fingerprint) == 16);

}  // namespace homing

#endif  // HOMING_LANDMARK_FINGERPRINT_H_
