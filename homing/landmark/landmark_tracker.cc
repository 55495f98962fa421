#include "homing/landmark/landmark_tracker.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace homing {
namespace {

constexpr std::int32_t kNew = -1;

// A landmark seen now, by its index, that may continue a known one.
struct Pair {
  double distance;
  std::int32_t landmark;
  std::size_t seen;
  bool operator<(const Pair& other) const {
    return std::tie(distance, landmark, seen) <
           std::tie(other.distance, other.landmark, other.seen);
  }
};

// Pixels between the known mean and the place where the flow puts the seen mean `steps` ago.
double DistanceBack(const SeenLandmark& seen, const Fingerprint& before, std::int64_t steps) {
  const auto g = static_cast<double>(steps);
  return std::hypot(double{seen.x} - g * seen.flow_x - double{before.x},
                    double{seen.y} - g * seen.flow_y - double{before.y});
}

// For each seen landmark the known one it continues, or kNew. One to one; the nearest pair first.
std::vector<std::int32_t> Assign(std::vector<Pair> pairs, std::size_t seen_count) {
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::int32_t> result(seen_count, kNew);
  for (const Pair& pair : pairs) {
    const bool taken = std::find(result.begin(), result.end(), pair.landmark) != result.end();
    if (!taken && result[pair.seen] == kNew) {
      result[pair.seen] = pair.landmark;
    }
  }
  return result;
}

}  // namespace

LandmarkTracker::LandmarkTracker(const LandmarkOptions& options) : options_(options) {}

std::vector<Fingerprint> LandmarkTracker::Associate(std::int64_t step, Side side,
                                                    const std::vector<SeenLandmark>& seen) {
  Forget(step, side);
  std::vector<Pair> pairs;
  for (const Active& active : active_[static_cast<std::size_t>(side)]) {
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const double distance = DistanceBack(seen[i], active.fingerprint, step - active.step);
      if (active.step < step && distance <= options_.max_track_distance_px) {
        pairs.push_back({distance, active.fingerprint.landmark, i});
      }
    }
  }
  const std::vector<std::int32_t> landmarks = Assign(std::move(pairs), seen.size());
  std::vector<Fingerprint> fingerprints;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const std::int32_t landmark = landmarks[i] == kNew ? next_landmark_ : landmarks[i];
    fingerprints.push_back({seen[i].x, seen[i].y, seen[i].count, landmark});
    Restore(step, side, fingerprints.back());
  }
  return fingerprints;
}

void LandmarkTracker::Restore(std::int64_t step, Side side, const Fingerprint& fingerprint) {
  next_landmark_ = std::max(next_landmark_, fingerprint.landmark + 1);
  Forget(step, side);
  std::vector<Active>& active = active_[static_cast<std::size_t>(side)];
  std::erase_if(active, [&fingerprint](const Active& a) {
    return a.fingerprint.landmark == fingerprint.landmark;
  });
  active.push_back({step, fingerprint});
}

// A landmark that was missing for more than the allowed steps gets a new number when it is back.
void LandmarkTracker::Forget(std::int64_t step, Side side) {
  std::erase_if(active_[static_cast<std::size_t>(side)], [this, step](const Active& active) {
    return step - active.step > options_.max_track_gap_steps + 1;
  });
}

}  // namespace homing
