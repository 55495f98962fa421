// Which stored landmarks resemble what is seen: the best P_T over one or more journeys
// (paper III, eqs 13 to 15).
#ifndef HOMING_LOCALIZATION_MATCHER_H_
#define HOMING_LOCALIZATION_MATCHER_H_

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "homing/journey/journey_map.h"
#include "homing/landmark/landmark_finder.h"
#include "homing/similarity/similarity.h"

namespace homing {

// Whether the cameras changed sides of the route. Direction is always estimated.
enum class Travel { kReturn = 1, kSame = 2 };

// The side of the route that a camera of the robot looks at.
Side RouteSide(Side camera, Travel travel);

// Landmarks seen at one instant, indexed by side of the ROUTE.
using SeenSides = std::array<std::vector<SeenLandmark>, 2>;

// A journey to search; does not own.
struct JourneyRef {
  const std::string* name = nullptr;
  const JourneyMap* map = nullptr;
};

struct Match {
  // Index into the journeys searched.
  int journey = 0;
  std::int32_t landmark = 0;
  std::int64_t step = 0;
  Side side = Side::kLeft;
  Similarity similarity;
};

struct MatchOptions {
  // Most landmarks returned. [1, 1000].
  int max_matches = 10;
  // Least P_T returned. [0, 1].
  double threshold = kRecognitionThreshold;
};

absl::Status Validate(const MatchOptions& options);

// Distinct landmarks, each with its best step over everything seen on its side; best P_T first,
// ties by journey name, step, side, landmark. Each journey is scored with its own deviation model.
// A P_T of 0 is no match.
std::vector<Match> FindMatches(std::span<const JourneyRef> journeys, const SeenSides& seen,
                               const MatchOptions& options);

// The best of one journey's steps from `first` to `last`, if any reaches the threshold. REQUIRES:
// both are steps of the map.
std::optional<Match> BestMatchWithin(const JourneyRef& journey, std::int64_t first,
                                     std::int64_t last, const SeenSides& seen, double threshold);

}  // namespace homing

#endif  // HOMING_LOCALIZATION_MATCHER_H_
