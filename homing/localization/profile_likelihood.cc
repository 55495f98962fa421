#include "homing/localization/profile_likelihood.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace homing {
namespace {

// What a side says on a foreign route, logarithm: the best of many steps looks good.
constexpr double kFirstForeignEvidence = 0.18;
constexpr double kForeignEvidence = 0.33;
// Most distances that are looked at for that.
constexpr std::size_t kMostSamples = 1024;
// Deviation of the offset from the outbound path, and the probability a step of another one.
constexpr double kOffsetDeviation = 0.15;
constexpr double kOffsetChange = 0.01;

const std::array<double, kPathOffsets.size()>& OffsetPrior() {
  static const auto prior = [] {
    std::array<double, kPathOffsets.size()> all{};
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i] = std::exp(-0.5 * std::pow(kPathOffsets[i] / kOffsetDeviation, 2));
    }
    const double sum = std::accumulate(all.begin(), all.end(), 0.0);
    for (double& value : all) {
      value /= sum;
    }
    return all;
  }();
  return prior;
}

bool HasProfiles(const JourneyRef& journey, std::size_t side) {
  return !journey.map->profiles(Side{static_cast<int>(side)}).empty();
}

}  // namespace

ProfileLikelihood::ProfileLikelihood() : offsets_(OffsetPrior()) {
  for (std::size_t view = 0; view < kViews; ++view) {
    covered_[view] = CoveredCells(1 + kPathOffsets[view]);
  }
}

bool ProfileLikelihood::CanCompare(std::span<const JourneyRef> journeys, const SeenProfiles& seen) {
  return std::ranges::any_of(journeys, [&seen](const JourneyRef& journey) {
    return (!seen[0].empty() && HasProfiles(journey, 0)) ||
           (!seen[1].empty() && HasProfiles(journey, 1));
  });
}

void ProfileLikelihood::Compute(std::span<const JourneyRef> journeys, const SeenProfiles& seen,
                                std::span<const std::vector<double>> predicted) {
  for (std::size_t side = 0; side < seen.size(); ++side) {
    compared_[side] =
        !seen[side].empty() && std::ranges::any_of(journeys, [side](const JourneyRef& journey) {
          return HasProfiles(journey, side);
        });
    if (compared_[side]) {
      Measure(journeys, side, seen[side]);
    }
  }
  Weigh(predicted);
  off_route_ = (first_ ? kFirstForeignEvidence : kForeignEvidence) *
               ((compared_[0] ? 1 : 0) + (compared_[1] ? 1 : 0));
  first_ = false;
}

void ProfileLikelihood::Measure(std::span<const JourneyRef> journeys, std::size_t side,
                                const ProfileViews& seen) {
  for (std::size_t view = 0; view < kViews; ++view) {
    Distances& distances = distances_[side][view];
    distances.resize(journeys.size());
    for (std::size_t i = 0; i < journeys.size(); ++i) {
      const auto stored = journeys[i].map->profiles(Side{static_cast<int>(side)});
      distances[i].resize(stored.size());
      ProfileDistances(seen[view], stored, covered_[view], distances[i]);
    }
    scales_[side][view] = ScaleOfAll(distances);
  }
}

DistanceScale ProfileLikelihood::ScaleOfAll(const Distances& distances) {
  std::size_t all = 0;
  for (const auto& of_journey : distances) {
    all += of_journey.size();
  }
  const std::size_t stride = all / kMostSamples + 1;
  sample_.clear();
  std::size_t skip = 0;
  for (const auto& of_journey : distances) {
    for (; skip < of_journey.size(); skip += stride) {
      sample_.push_back(of_journey[skip]);
    }
    skip -= of_journey.size();
  }
  return ScaleOf(sample_);
}

void ProfileLikelihood::Multiply(std::size_t side, std::size_t view, std::size_t journey,
                                 std::vector<float>& factors) const {
  const std::vector<std::uint16_t>& distances = distances_[side][view][journey];
  const DistanceScale scale = scales_[side][view];
  const ProfileRatio& ratio = first_ ? ProfileRatio::First() : ProfileRatio::Further();
  for (std::size_t step = 0; step < distances.size(); ++step) {
    factors[step] *= ratio(scale.Deviations(distances[step]));
  }
}

// Each step's ratio is the mean over the offsets; an offset under which the believed steps fit
// gains.
void ProfileLikelihood::Weigh(std::span<const std::vector<double>> predicted) {
  likelihoods_.resize(predicted.size());
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    likelihoods_[i].assign(predicted[i].size(), 0);
  }
  std::array<double, kViews> fit{};
  for (std::size_t offset = 0; offset < kViews; ++offset) {
    for (std::size_t i = 0; i < predicted.size(); ++i) {
      factors_.assign(predicted[i].size(), 1);
      for (std::size_t side = 0; side < compared_.size(); ++side) {
        if (compared_[side]) Multiply(side, ViewOf(side, offset), i, factors_);
      }
      const auto weight = static_cast<float>(offsets_[offset]);
      for (std::size_t step = 0; step < factors_.size(); ++step) {
        likelihoods_[i][step] += weight * factors_[step];
        fit[offset] += predicted[i][step] * double{factors_[step]};
      }
    }
  }
  double sum = 0;
  for (std::size_t offset = 0; offset < kViews; ++offset) {
    offsets_[offset] *= fit[offset];
    sum += offsets_[offset];
  }
  for (std::size_t offset = 0; offset < kViews; ++offset) {
    offsets_[offset] = sum > 0 ? (1 - kOffsetChange) * offsets_[offset] / sum +
                                     kOffsetChange * OffsetPrior()[offset]
                               : OffsetPrior()[offset];
  }
}

}  // namespace homing
