// max(floor, P_T) by table, for the inner loop of the filter; P_T itself (eqs 13 to 15) is
// in homing/similarity.
#ifndef HOMING_PROFILE_FACTOR_TABLE_H_
#define HOMING_PROFILE_FACTOR_TABLE_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "homing/landmark/fingerprint.h"
#include "homing/landmark/landmark_finder.h"
#include "homing/similarity/deviation_model.h"

namespace homing {

// Immutable; within 1e-3 of the exact value.
class FactorTable {
 public:
  // REQUIRES: Validate(model).ok(), floor in (0, 1).
  FactorTable(const DeviationModel& model, double floor);

  float operator()(const SeenLandmark& seen, const Fingerprint& stored) const {
    const float dx = seen.x - stored.x;
    const float dy = seen.y - stored.y;
    const float at = std::sqrt(dx * dx + dy * dy) * entries_per_px_;
    if (!(at < kEntries)) {
      return floor_;
    }
    const auto entry = static_cast<std::size_t>(at);
    const float part = at - static_cast<float>(entry);
    const float p = survival_[entry] + part * (survival_[entry + 1] - survival_[entry]);
    const auto [low, high] = std::minmax(seen.count, stored.count);
    return std::max(floor_, p * (static_cast<float>(low) / static_cast<float>(high)));
  }

 private:
  static constexpr float kEntries = 4096;

  float floor_;
  float entries_per_px_ = 0;
  // 1 - F over delta.
  std::vector<float> survival_;
};

}  // namespace homing

#endif  // HOMING_PROFILE_FACTOR_TABLE_H_
