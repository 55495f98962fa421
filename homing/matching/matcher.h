// Finds the stored landmarks that are most similar to those seen: the best P_T over one or more
// journeys (paper III, eqs 13 to 15).
#ifndef HOMING_MATCHING_MATCHER_H_
#define HOMING_MATCHING_MATCHER_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "homing/base/cancellation.h"
#include "homing/journey/journey_map.h"
#include "homing/journey/journey_ref.h"
#include "homing/journey/see_landmarks.h"
#include "homing/matching/survival_bound.h"
#include "homing/similarity/similarity.h"

namespace homing {

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

// Not thread-safe: it reuses its memory from query to query.
class Matcher {
 public:
  // Distinct landmarks, each with its best step for all landmarks seen on its side; best P_T first,
  // ties by journey name, step, side, landmark. Each journey uses its own deviation model. A P_T of
  // 0 is no match. Once `cancellation` is cancelled, the result is incomplete. `likely`: a P_T that
  // max_matches landmarks probably reach. It changes the time that this takes, not the result.
  // REQUIRES: Validate(options).ok().
  std::vector<Match> Find(std::span<const JourneyRef> journeys, const SeenSides& seen,
                          const MatchOptions& options, const Cancellation* cancellation = nullptr,
                          double likely = kMuchAlike);

  // The best of one journey's steps from `first` to `last`, if any reaches the threshold.
  // REQUIRES: both are steps of the map.
  std::optional<Match> FindBestWithin(const JourneyRef& journey, std::int64_t first,
                                      std::int64_t last, const SeenSides& seen, double threshold);

 private:
  // In most queries some landmarks of a journey reach this P_T.
  static constexpr double kMuchAlike = 0.5;
  // Stored fingerprints tested at a time: their flags fit into the cache.
  static constexpr std::size_t kTile = 256;

  // A pair that may reach the threshold.
  struct Candidate {
    const Fingerprint* stored = nullptr;
    const SeenLandmark* seen = nullptr;
    // Index into the journeys.
    int journey = 0;
    // Number of the landmark over all journeys.
    std::size_t landmark = 0;
    // An upper bound of P_T.
    float most = 0;
  };

  // One entry of the list of landmarks seen on either side of the route.
  struct SeenPlace {
    const SeenLandmark* landmark = nullptr;
    float x = 0;
    float y = 0;
    Side side = Side::kLeft;
  };

  const SurvivalBound& BoundOf(const DeviationModel& model);
  void Clear();
  // Scans steps of journey `number`.
  void Scan(std::span<const JourneyRef> journeys, int number, std::int64_t first, std::int64_t last,
            const SeenSides& seen, double threshold);
  // Selects, of at most kTile fingerprints, those within this squared distance of a seen landmark.
  std::span<const Fingerprint* const> FindNear(std::span<const Fingerprint> tile, float reach);
  // Scans all steps of all journeys.
  void ScanAll(std::span<const JourneyRef> journeys, const SeenSides& seen, double threshold);
  // A lower bound of the P_T of the `most`-th best landmark. Call it once a scan.
  float LeastOfBest(int most);
  // Moves the candidates whose P_T may reach `of_best` into the matches: the best of each landmark.
  void Compute(std::span<const JourneyRef> journeys, double threshold, float of_best);

  std::vector<std::pair<DeviationModel, std::unique_ptr<const SurvivalBound>>> bounds_;
  std::vector<SeenPlace> all_seen_;
  // The near fingerprints of the current tile.
  std::array<const Fingerprint*, kTile> near_;
  std::vector<Candidate> candidates_;
  std::vector<Match> matches_;
  // The landmarks that have or had candidates.
  std::vector<std::size_t> touched_;
  const Cancellation* cancellation_ = nullptr;
  // The bounds of candidates, by landmark.
  struct KnownLandmark {
    // A lower bound of its P_T.
    float least = 0;
    // The index of its match, or -1.
    std::int32_t match = -1;
    bool is_touched = false;
  };
  // Landmarks of all scanned journeys.
  std::size_t landmark_count_ = 0;
  // Indexed by landmark over all journeys.
  std::vector<KnownLandmark> known_;
  std::vector<float> positive_;
};

}  // namespace homing

#endif  // HOMING_MATCHING_MATCHER_H_
