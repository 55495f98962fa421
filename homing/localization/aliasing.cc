#include "homing/localization/aliasing.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>

#include "homing/profile/profile_distance.h"
#include "homing/profile/profile_evidence.h"

namespace homing {
namespace {

constexpr std::int64_t kStepsTried = 100;
constexpr double kKnown = 0.9;
// Most places tried times steps of the route.
constexpr std::int64_t kMostComparisons = 2'000'000;
// Steps after which aliased places are determined.
constexpr std::int64_t kAliasedSteps = 5;
constexpr double kLeastConfusion = 0.1;
constexpr std::size_t kMostAliased = 20;
// Weight of one observation: neighbouring ones show nearly the same.
constexpr double kWeight = 0.3;

// A robot that starts at one place: the probability of the other places as it sees more and more
// steps.
class Drive {
 public:
  Drive(const RouteProfiles& profiles, std::int64_t step_count, std::int64_t start)
      : profiles_(&profiles),
        start_(start),
        along_(static_cast<std::size_t>(step_count), 1),
        against_(along_) {}

  // The robot sees step start + `seen`.
  void See(std::int64_t seen) {
    for (const std::vector<FlowProfile>& stored : *profiles_) {
      if (!stored.empty()) SeeSide(stored, seen);
    }
  }

  // Probability of the start, of steps within `tolerance` of it.
  double Certainty(std::int64_t tolerance) const {
    double here = 0;
    double elsewhere = 0;
    for (std::int64_t s = 0; s < std::ssize(along_); ++s) {
      (std::abs(s - start_) <= tolerance ? here : elsewhere) += Confusion(s);
    }
    return here / (here + elsewhere);
  }

  AliasedPlaces MostConfused(std::int64_t tolerance) const {
    AliasedPlaces aliased{.first_step = start_, .second_step = start_, .confusion = 0};
    for (std::int64_t s = 0; s < std::ssize(along_); ++s) {
      if (std::abs(s - start_) > tolerance && Confusion(s) > aliased.confusion) {
        aliased.second_step = s;
        aliased.confusion = Confusion(s);
      }
    }
    return aliased;
  }

 private:
  double Confusion(std::int64_t step) const {
    const auto at = static_cast<std::size_t>(step);
    return std::min(1.0, std::max(along_[at], against_[at]));
  }

  void SeeSide(const std::vector<FlowProfile>& stored, std::int64_t seen) {
    const std::int64_t count = std::ssize(along_);
    const std::int64_t at = start_ + seen;
    const FlowProfile& view = stored[static_cast<std::size_t>(at)];
    if (view == FlowProfile{}) return;
    static const CellMask all = CoveredCells(1);
    distances_.resize(stored.size());
    ProfileDistances(view, stored, all, distances_);
    const DistanceScale scale = ScaleOf(distances_);
    const std::int64_t beside = at + 1 < count ? at + 1 : at - 1;
    const double expected = Ratio(scale, std::max<std::int64_t>(beside, 0));
    // Positions beyond the ends are no places.
    for (std::int64_t s = 0; s < count; ++s) {
      const auto i = static_cast<std::size_t>(s);
      along_[i] *= s + seen < count ? Ratio(scale, s + seen) / expected : 0;
      against_[i] *= s - seen >= 0 ? Ratio(scale, s - seen) / expected : 0;
    }
  }

  double Ratio(const DistanceScale& scale, std::int64_t step) const {
    return double{ProfileRatio::OfWeight(kWeight)(
        scale.Deviations(distances_[static_cast<std::size_t>(step)]))};
  }

  const RouteProfiles* profiles_;
  std::int64_t start_;
  // Likelihood by step where the robot may have started, if it drives as outbound or the other way.
  std::vector<double> along_;
  std::vector<double> against_;
  std::vector<std::uint16_t> distances_;
};

bool Near(const AliasedPlaces& a, const AliasedPlaces& b, std::int64_t tolerance) {
  const auto within = [tolerance](std::int64_t s, std::int64_t t) {
    return std::abs(s - t) <= tolerance;
  };
  return (within(a.first_step, b.first_step) && within(a.second_step, b.second_step)) ||
         (within(a.first_step, b.second_step) && within(a.second_step, b.first_step));
}

// Each pair once.
std::vector<AliasedPlaces> Distinct(std::vector<AliasedPlaces> all, std::int64_t tolerance) {
  std::ranges::stable_sort(all, std::ranges::greater{}, &AliasedPlaces::confusion);
  std::vector<AliasedPlaces> distinct;
  for (const AliasedPlaces& aliased : all) {
    const bool known = std::ranges::any_of(
        distinct, [&](const AliasedPlaces& other) { return Near(aliased, other, tolerance); });
    if (!known && distinct.size() < kMostAliased) distinct.push_back(aliased);
  }
  return distinct;
}

// `steps` is sorted; kStepsTried + 1 stands for a place that is never known.
std::optional<std::int64_t> Quantile(const std::vector<std::int64_t>& steps, double share) {
  const auto at = static_cast<std::size_t>(std::ceil(share * static_cast<double>(steps.size())));
  const std::int64_t value = steps[std::max<std::size_t>(at, 1) - 1];
  return value > kStepsTried ? std::nullopt : std::optional(value);
}

}  // namespace

Aliasing AnalyzeAliasing(RouteProfiles profiles, std::int64_t tolerance_steps,
                         const Cancellation* cancellation) {
  const auto count = std::max(std::ssize(profiles[0]), std::ssize(profiles[1]));
  Aliasing aliasing;
  if (count == 0) return aliasing;
  for (std::vector<FlowProfile>& side : profiles) {
    if (!side.empty()) side.resize(static_cast<std::size_t>(count));
  }
  const std::int64_t stride = count * count / kMostComparisons + 1;
  std::vector<std::int64_t> steps;
  std::vector<AliasedPlaces> aliased;
  std::int64_t indistinct = 0;
  const auto is_awaited = [cancellation] { return CheckAwaited(cancellation).ok(); };
  for (std::int64_t start = 0; start < count && is_awaited(); start += stride) {
    Drive drive(profiles, count, start);
    // At the end of the route there is nothing more to see.
    const std::int64_t most = std::min(kStepsTried, count - start);
    std::int64_t needed = kStepsTried + 1;
    for (std::int64_t seen = 0; seen < most && needed > kStepsTried && is_awaited(); ++seen) {
      drive.See(seen);
      if (drive.Certainty(tolerance_steps) >= kKnown) needed = seen + 1;
      if (seen + 1 == kAliasedSteps || (needed <= kStepsTried && seen + 1 < kAliasedSteps)) {
        const AliasedPlaces found = drive.MostConfused(tolerance_steps);
        if (found.confusion >= kLeastConfusion) aliased.push_back(found);
      }
    }
    if (needed > kStepsTried && most < kStepsTried) continue;
    indistinct += needed > kStepsTried ? 1 : 0;
    steps.push_back(needed);
  }
  if (steps.empty()) {
    aliasing.indistinct_share = 1;
  } else {
    std::ranges::sort(steps);
    aliasing.median_steps = Quantile(steps, 0.5);
    aliasing.most_steps = Quantile(steps, 0.95);
    aliasing.indistinct_share = static_cast<double>(indistinct) / static_cast<double>(steps.size());
  }
  aliasing.aliased_places = Distinct(std::move(aliased), tolerance_steps);
  return aliasing;
}

}  // namespace homing
