#include "homing/matching/matcher.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <tuple>

#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"
#include "homing/base/vector_clones.h"

namespace homing {
namespace {

// Deviation models whose bounds are kept. Most journeys have the same.
constexpr std::size_t kMostBounds = 64;

// Twice the rounding error of a bound's product in float.
constexpr float kProductRounding = 1e-6F;
// Candidates kept before they are computed: 20 MB. A query with a low threshold may have far more
// pairs than there are stored fingerprints.
constexpr std::size_t kMostCandidates = std::size_t{1} << 19;

MeanAndCount Of(const SeenLandmark& seen) {
  return {double{seen.x}, double{seen.y}, static_cast<double>(seen.count)};
}

MeanAndCount Of(const Fingerprint& stored) {
  return {double{stored.x}, double{stored.y}, static_cast<double>(stored.count)};
}

float SquaredDistance(const Fingerprint& stored, float x, float y) {
  const float dx = stored.x - x;
  const float dy = stored.y - y;
  return dx * dx + dy * dy;
}

// 1 for each entry nearer than `reach` to one of two places, else 0. Two places at once halve the
// reading of stored data.
HOMING_VECTOR_CLONES
void FlagNear(std::span<const Fingerprint> stored, float x, float y, float other_x, float other_y,
              float reach, std::uint8_t* __restrict flags) {
  const Fingerprint* const from = stored.data();
  for (std::size_t i = 0; i < stored.size(); ++i) {
    const float one = SquaredDistance(from[i], x, y);
    const float other = SquaredDistance(from[i], other_x, other_y);
    flags[i] = static_cast<std::uint8_t>(flags[i] | (std::min(one, other) < reach ? 1 : 0));
  }
}

// Best P_T first; ties by step, side, landmark.
bool IsBetter(const Match& a, const Match& b) {
  if (a.similarity.p_t != b.similarity.p_t) {
    return a.similarity.p_t > b.similarity.p_t;
  }
  return std::tie(a.step, a.side, a.landmark) < std::tie(b.step, b.side, b.landmark);
}

}  // namespace

absl::Status Validate(const MatchOptions& options) {
  HOMING_RETURN_IF_ERROR(CheckRange("max_matches", options.max_matches, 1, 1000));
  return CheckRange("threshold", options.threshold, 0.0, 1.0);
}

const SurvivalBound& Matcher::BoundOf(const DeviationModel& model) {
  const auto known =
      std::ranges::find_if(bounds_, [&model](const auto& entry) { return entry.first == model; });
  if (known != bounds_.end()) {
    return *known->second;
  }
  if (bounds_.size() == kMostBounds) bounds_.clear();
  return *bounds_.emplace_back(model, std::make_unique<const SurvivalBound>(model)).second;
}

void Matcher::Clear() {
  for (const std::size_t landmark : touched_) known_[landmark] = {};
  touched_.clear();
  candidates_.clear();
  matches_.clear();
  landmark_count_ = 0;
}

// Upper bounds of each pair's P_T: the ratio of counts (eq 15) times the bound of 1 - F (eq 14).
void Matcher::Scan(std::span<const JourneyRef> journeys, int number, std::int64_t first,
                   std::int64_t last, const SeenSides& seen, double threshold) {
  const JourneyMap& map = *journeys[static_cast<std::size_t>(number)].map;
  const SurvivalBound& bound = BoundOf(map.settings().deviation_model);
  // The distance alone excludes most pairs.
  const float reach = bound.ReachOf(threshold / (1 + 2 * double{kProductRounding}));
  all_seen_.clear();
  for (std::size_t side = 0; side < seen.size(); ++side) {
    for (const SeenLandmark& landmark : seen[side]) {
      all_seen_.push_back({&landmark, landmark.x, landmark.y, static_cast<Side>(side)});
    }
  }
  const std::size_t before = landmark_count_;
  landmark_count_ += map.landmarks().size();
  if (known_.size() < landmark_count_) known_.resize(landmark_count_);
  if (last < first) return;
  std::span<const Fingerprint> all(map.fingerprints(first).begin(), map.fingerprints(last).end());
  while (!all.empty() && CheckAwaited(cancellation_).ok()) {
    if (candidates_.size() >= kMostCandidates) Compute(journeys, threshold, 0);
    const std::span<const Fingerprint> tile = all.first(std::min(all.size(), kTile));
    all = all.subspan(tile.size());
    for (const Fingerprint* const near : FindNear(tile, reach)) {
      const Fingerprint& stored = *near;
      for (const SeenPlace& place : all_seen_) {
        const float squared = SquaredDistance(stored, place.x, place.y);
        if (squared >= reach || map.side_of(stored) != place.side) continue;
        const SeenLandmark& landmark = *place.landmark;
        const auto [low, high] = std::minmax(stored.count, landmark.count);
        const float ratio = static_cast<float>(low) / static_cast<float>(high);
        const float most = ratio * bound.At(squared) * (1 + kProductRounding);
        if (double{most} < threshold) continue;
        const std::size_t of = before + static_cast<std::size_t>(stored.landmark);
        candidates_.push_back({&stored, &landmark, number, of, most});
        const float least = ratio * bound.LeastAt(squared) * (1 - kProductRounding);
        KnownLandmark& known = known_[of];
        if (!known.is_touched) touched_.push_back(of);
        known.is_touched = true;
        known.least = std::max(known.least, least);
      }
    }
  }
}

// Most flags are 0: eight of them are tested together.
std::span<const Fingerprint* const> Matcher::FindNear(std::span<const Fingerprint> tile,
                                                      float reach) {
  std::array<std::uint8_t, kTile> flags{};
  for (std::size_t i = 0; i < all_seen_.size(); i += 2) {
    const SeenPlace& one = all_seen_[i];
    const SeenPlace& other = all_seen_[std::min(i + 1, all_seen_.size() - 1)];
    FlagNear(tile, one.x, one.y, other.x, other.y, reach, flags.data());
  }
  std::size_t count = 0;
  for (std::size_t begin = 0; begin < tile.size(); begin += sizeof(std::uint64_t)) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, flags.data() + begin, sizeof(eight));
    for (std::size_t i = begin; eight != 0; ++i, eight >>= 8U) {
      near_[count] = &tile[i];
      count += eight & 1U;
    }
  }
  return std::span(near_).first(count);
}

float Matcher::LeastOfBest(int most) {
  positive_.clear();
  for (const std::size_t landmark : touched_) {
    if (known_[landmark].least > 0) positive_.push_back(known_[landmark].least);
  }
  if (std::ssize(positive_) < most) {
    return 0;
  }
  const auto last = positive_.begin() + most - 1;
  std::nth_element(positive_.begin(), last, positive_.end(), std::greater());
  return *last;
}

void Matcher::Compute(std::span<const JourneyRef> journeys, double threshold, float of_best) {
  for (const Candidate& candidate : candidates_) {
    KnownLandmark& known = known_[candidate.landmark];
    if (candidate.most < std::max(of_best, known.least)) continue;
    const JourneyMap& map = *journeys[static_cast<std::size_t>(candidate.journey)].map;
    const Similarity similarity =
        Compare(Of(*candidate.seen), Of(*candidate.stored), map.settings().deviation_model);
    if (similarity.p_t <= 0 || similarity.p_t < threshold) continue;
    if (known.match < 0) {
      known.match = static_cast<std::int32_t>(matches_.size());
      matches_.emplace_back();
    }
    Match& best = matches_[static_cast<std::size_t>(known.match)];
    if (similarity.p_t > best.similarity.p_t) {
      best = {.journey = candidate.journey,
              .landmark = candidate.stored->landmark,
              .step = map.step_of(*candidate.stored),
              .side = map.side_of(*candidate.stored),
              .similarity = similarity};
    }
  }
  candidates_.clear();
}

void Matcher::ScanAll(std::span<const JourneyRef> journeys, const SeenSides& seen,
                      double threshold) {
  Clear();
  for (std::size_t i = 0; i < journeys.size(); ++i) {
    Scan(journeys, static_cast<int>(i), 0, journeys[i].map->step_count() - 1, seen, threshold);
  }
}

std::vector<Match> Matcher::Find(std::span<const JourneyRef> journeys, const SeenSides& seen,
                                 const MatchOptions& options, const Cancellation* cancellation,
                                 double likely) {
  cancellation_ = cancellation;
  // Scan with a high threshold first; with a lower one only if that gives too few matches.
  float of_best = 0;
  for (double tried = 2; const double next : {likely, kMuchAlike, options.threshold}) {
    const double threshold = std::max(options.threshold, next);
    if (double{of_best} >= tried || threshold >= tried) continue;
    tried = threshold;
    ScanAll(journeys, seen, threshold);
    of_best = LeastOfBest(options.max_matches);
  }
  Compute(journeys, options.threshold, of_best);
  std::vector<Match> matches = std::move(matches_);
  const auto name = [&journeys](const Match& match) -> const std::string& {
    return *journeys[static_cast<std::size_t>(match.journey)].name;
  };
  const auto before = [&name](const Match& a, const Match& b) {
    if (a.similarity.p_t == b.similarity.p_t && a.journey != b.journey) {
      return name(a) < name(b);
    }
    return IsBetter(a, b);
  };
  if (std::ssize(matches) > options.max_matches) {
    std::nth_element(matches.begin(), matches.begin() + options.max_matches, matches.end(), before);
    matches.resize(static_cast<std::size_t>(options.max_matches));
  }
  std::ranges::sort(matches, before);
  return matches;
}

std::optional<Match> Matcher::FindBestWithin(const JourneyRef& journey, std::int64_t first,
                                             std::int64_t last, const SeenSides& seen,
                                             double threshold) {
  cancellation_ = nullptr;
  Clear();
  Scan({&journey, 1}, 0, first, last, seen, threshold);
  Compute({&journey, 1}, threshold, LeastOfBest(1));
  const auto best = std::ranges::min_element(matches_, IsBetter);
  return best == matches_.end() ? std::nullopt : std::optional(*best);
}

}  // namespace homing
