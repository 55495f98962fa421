#include "homing/localization/matcher.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "homing/range_check.h"
#include "homing/status_macros.h"

namespace homing {
namespace {

// Pairs whose bound is below this share of the least P_T asked for are not computed.
constexpr double kBoundMargin = 1 - 1e-9;

MeanAndCount Of(const SeenLandmark& seen) {
  return {double{seen.x}, double{seen.y}, static_cast<double>(seen.count)};
}

MeanAndCount Of(const Fingerprint& stored) {
  return {double{stored.x}, double{stored.y}, static_cast<double>(stored.count)};
}

// The distance beyond which 1 - F is below `probability`: no pair further apart reaches it.
double FurthestDistance(const DeviationModel& model, double probability) {
  double near = -700;
  double far = 700;
  // Bisection over ln delta; 1 - F falls with delta.
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (near + far);
    (Survival(model, std::exp(middle)) >= probability ? near : far) = middle;
  }
  return std::exp(far);
}

// Best P_T first; ties by step, side, landmark.
bool IsBetter(const Match& a, const Match& b) {
  if (a.similarity.p_t != b.similarity.p_t) {
    return a.similarity.p_t > b.similarity.p_t;
  }
  return std::tie(a.step, a.side, a.landmark) < std::tie(b.step, b.side, b.landmark);
}

// The best step of each landmark of one journey, found in one pass over its steps.
class JourneyScan {
 public:
  JourneyScan(const JourneyMap& map, double threshold)
      : map_(map),
        threshold_(threshold),
        furthest_(FurthestDistance(map.settings().deviation_model, threshold * kBoundMargin)),
        best_(map.landmarks().size()) {}

  // The landmarks recognised from step `first` to `last`, in the order met.
  std::vector<Match> Scan(const SeenSides& seen, std::int64_t first, std::int64_t last) {
    for (std::int64_t step = first; step <= last; ++step) {
      for (const Fingerprint& stored : map_.fingerprints(step)) {
        for (const SeenLandmark& landmark : seen[static_cast<std::size_t>(map_.side_of(stored))]) {
          Consider(step, stored, landmark);
        }
      }
    }
    std::vector<Match> matches;
    std::copy_if(best_.begin(), best_.end(), std::back_inserter(matches),
                 [](const Match& match) { return match.similarity.p_t > 0; });
    return matches;
  }

 private:
  void Consider(std::int64_t step, const Fingerprint& stored, const SeenLandmark& landmark) {
    Match& best = best_[static_cast<std::size_t>(stored.landmark)];
    const double least = std::max(threshold_, best.similarity.p_t) * kBoundMargin;
    const auto [low, high] = std::minmax(stored.count, landmark.count);
    // Two bounds of P_T: the ratio of numbers (eq 15), and 1 - F (eq 14).
    if (low < least * high || std::abs(double{stored.x} - double{landmark.x}) > furthest_ ||
        std::abs(double{stored.y} - double{landmark.y}) > furthest_) {
      return;
    }
    const Similarity similarity =
        Compare(Of(landmark), Of(stored), map_.settings().deviation_model);
    if (similarity.p_t >= threshold_ && similarity.p_t > best.similarity.p_t) {
      best = {.journey = 0,
              .landmark = stored.landmark,
              .step = step,
              .side = map_.side_of(stored),
              .similarity = similarity};
    }
  }

  const JourneyMap& map_;
  double threshold_;
  double furthest_;
  // Indexed by landmark; P_T of 0: none.
  std::vector<Match> best_;
};

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

std::vector<Match> FindMatches(std::span<const JourneyRef> journeys, const SeenSides& seen,
                               const MatchOptions& options) {
  std::vector<Match> matches;
  for (std::size_t i = 0; i < journeys.size(); ++i) {
    const JourneyMap& map = *journeys[i].map;
    for (Match& match : JourneyScan(map, options.threshold).Scan(seen, 0, map.step_count() - 1)) {
      match.journey = static_cast<int>(i);
      matches.push_back(match);
    }
  }
  const auto name = [&journeys](const Match& match) -> const std::string& {
    return *journeys[static_cast<std::size_t>(match.journey)].name;
  };
  const auto before = [&name](const Match& a, const Match& b) {
    if (a.similarity.p_t == b.similarity.p_t && a.journey != b.journey) {
      return name(a) < name(b);
    }
    return IsBetter(a, b);
  };
  const auto kept = std::min(std::ptrdiff_t{options.max_matches}, std::ssize(matches));
  std::partial_sort(matches.begin(), matches.begin() + kept, matches.end(), before);
  matches.resize(static_cast<std::size_t>(kept));
  return matches;
}

std::optional<Match> BestMatchWithin(const JourneyRef& journey, std::int64_t first,
                                     std::int64_t last, const SeenSides& seen, double threshold) {
  const std::vector<Match> matches = JourneyScan(*journey.map, threshold).Scan(seen, first, last);
  const auto best = std::min_element(matches.begin(), matches.end(), IsBetter);
  return best == matches.end() ? std::nullopt : std::optional(*best);
}

}  // namespace homing
