#include "homing/localization/matcher.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <tuple>

#include "homing/range_check.h"
#include "homing/status_macros.h"
#include "homing/vector_clones.h"

namespace homing {
namespace {

// Covers the rounding of a bound's product in float, twice over.
constexpr float kProductRounding = 1e-6F;

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

HOMING_VECTOR_CLONES
void LowerToDistance(std::span<const Fingerprint> stored, float x, float y,
                     std::span<float> nearest) {
  const Fingerprint* const from = stored.data();
  float* const to = nearest.data();
  for (std::size_t i = 0; i < stored.size(); ++i) {
    to[i] = std::min(to[i], SquaredDistance(from[i], x, y));
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

Side RouteSide(Side camera, Travel travel) {
  if (travel == Travel::kSame) {
    return camera;
  }
  return camera == Side::kLeft ? Side::kRight : Side::kLeft;
}

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
  return *bounds_.emplace_back(model, std::make_unique<const SurvivalBound>(model)).second;
}

void Matcher::Clear() {
  candidates_.clear();
  least_.clear();
}

// Bounds of each pair's P_T: the ratio of numbers (eq 15) times those of 1 - F (eq 14).
void Matcher::Scan(int number, const JourneyMap& map, std::int64_t first, std::int64_t last,
                   const SeenSides& seen, double threshold) {
  const SurvivalBound& bound = BoundOf(map.settings().deviation_model);
  // Of most pairs the distance alone says that they are none.
  const float reach = bound.ReachOf(threshold / (1 + 2 * double{kProductRounding}));
  all_seen_.clear();
  for (std::size_t side = 0; side < seen.size(); ++side) {
    for (const SeenLandmark& landmark : seen[side]) {
      all_seen_.push_back({&landmark, landmark.x, landmark.y, static_cast<Side>(side)});
    }
  }
  const std::size_t before = least_.size();
  least_.resize(before + map.landmarks().size(), 0);
  if (last < first) return;
  const std::span<const Fingerprint> all(map.fingerprints(first).begin(),
                                         map.fingerprints(last).end());
  FindNear(all, reach);
  for (const std::uint32_t i : near_) {
    const Fingerprint& stored = all[i];
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
      least_[of] = std::max(least_[of], least);
    }
  }
}

// Without a branch: which ones are near depends on nothing that went before.
void Matcher::FindNear(std::span<const Fingerprint> stored, float reach) {
  nearest_.assign(stored.size(), std::numeric_limits<float>::infinity());
  for (const SeenPlace& place : all_seen_) {
    LowerToDistance(stored, place.x, place.y, nearest_);
  }
  near_.resize(stored.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < stored.size(); ++i) {
    near_[count] = static_cast<std::uint32_t>(i);
    count += nearest_[i] < reach ? 1 : 0;
  }
  near_.resize(count);
}

float Matcher::LeastOfBest(const MatchOptions& options) {
  positive_.clear();
  std::ranges::copy_if(least_, std::back_inserter(positive_),
                       [](float least) { return least > 0; });
  if (std::ssize(positive_) < options.max_matches) {
    return 0;
  }
  const auto last = positive_.begin() + options.max_matches - 1;
  std::nth_element(positive_.begin(), last, positive_.end(), std::greater());
  return *last;
}

std::vector<Match> Matcher::Compute(std::span<const JourneyRef> journeys,
                                    const MatchOptions& options) {
  const float of_best = LeastOfBest(options);
  match_of_.assign(least_.size(), -1);
  std::vector<Match> matches;
  for (const Candidate& candidate : candidates_) {
    if (candidate.most < std::max(of_best, least_[candidate.landmark])) continue;
    const JourneyMap& map = *journeys[static_cast<std::size_t>(candidate.journey)].map;
    const Similarity similarity =
        Compare(Of(*candidate.seen), Of(*candidate.stored), map.settings().deviation_model);
    if (similarity.p_t <= 0 || similarity.p_t < options.threshold) continue;
    std::int32_t& number = match_of_[candidate.landmark];
    if (number < 0) {
      number = static_cast<std::int32_t>(matches.size());
      matches.emplace_back();
    }
    Match& best = matches[static_cast<std::size_t>(number)];
    if (similarity.p_t > best.similarity.p_t) {
      best = {.journey = candidate.journey,
              .landmark = candidate.stored->landmark,
              .step = map.step_of(*candidate.stored),
              .side = map.side_of(*candidate.stored),
              .similarity = similarity};
    }
  }
  return matches;
}

std::vector<Match> Matcher::Find(std::span<const JourneyRef> journeys, const SeenSides& seen,
                                 const MatchOptions& options) {
  Clear();
  for (std::size_t i = 0; i < journeys.size(); ++i) {
    const JourneyMap& map = *journeys[i].map;
    Scan(static_cast<int>(i), map, 0, map.step_count() - 1, seen, options.threshold);
  }
  std::vector<Match> matches = Compute(journeys, options);
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
  Clear();
  Scan(0, *journey.map, first, last, seen, threshold);
  const std::vector<Match> matches =
      Compute({&journey, 1}, {.max_matches = 1, .threshold = threshold});
  const auto best = std::ranges::min_element(matches, IsBetter);
  return best == matches.end() ? std::nullopt : std::optional(*best);
}

}  // namespace homing
