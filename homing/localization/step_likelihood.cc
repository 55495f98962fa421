#include "homing/localization/step_likelihood.h"

#include <algorithm>
#include <cmath>

#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"

namespace homing {
namespace {

constexpr float kNotCompared = -1;

// Both of one side as one: where one histogram has a valley, the other may have none (Fig. 4).
template <typename T>
T Union(const T& a, const T& b) {
  T both = a;
  const auto count_a = static_cast<float>(a.count);
  const auto count_b = static_cast<float>(b.count);
  both.x = (a.x * count_a + b.x * count_b) / (count_a + count_b);
  both.y = (a.y * count_a + b.y * count_b) / (count_a + count_b);
  both.count = a.count + b.count;
  return both;
}

// One seen landmark: the better of the stored ones, or both as one.
float FactorOfOne(const SeenLandmark& seen, std::span<const Fingerprint> stored,
                  const FactorTable& table) {
  const float first = table(seen, stored[0]);
  return stored.size() == 1
             ? first
             : std::max({first, table(seen, stored[1]), table(seen, Union(stored[0], stored[1]))});
}

// The factors of one side's landmarks at one step, assigned one to one so that the product is
// greatest; kNotCompared for a landmark that is left over.
std::array<float, 2> Assign(std::span<const Fingerprint> stored,
                            const std::vector<SeenLandmark>& seen, const FactorTable& table) {
  if (stored.empty() || seen.empty()) {
    return {kNotCompared, kNotCompared};
  }
  if (seen.size() == 1) {
    return {FactorOfOne(seen[0], stored, table), kNotCompared};
  }
  const float first = table(seen[0], stored[0]);
  const float second = table(seen[1], stored[0]);
  if (stored.size() == 1) {
    const float both = table(Union(seen[0], seen[1]), stored[0]);
    if (both >= std::max(first, second)) return {both, kNotCompared};
    return first >= second ? std::array{first, kNotCompared} : std::array{kNotCompared, second};
  }
  const float first_other = table(seen[0], stored[1]);
  const float second_other = table(seen[1], stored[1]);
  if (first * second_other >= first_other * second) {
    return {first, second_other};
  }
  return {first_other, second};
}

}  // namespace

absl::Status Validate(const LikelihoodOptions& options) {
  HOMING_RETURN_IF_ERROR(CheckRange("floor", options.floor, 1e-9, 1 - 1e-9));
  HOMING_RETURN_IF_ERROR(CheckRange("outlier_share", options.outlier_share, 0.0, 1.0));
  HOMING_RETURN_IF_ERROR(CheckAbove("temper", options.temper, 0.0, 1.0));
  return CheckRange("off_route_share", options.off_route_share, 0.0, 1.0);
}

void StepLikelihood::ComputeFactors(const JourneyMap& map, const FactorTable& table,
                                    const SeenSides& seen, Factors& factors) {
  const auto steps = static_cast<std::size_t>(map.step_count());
  for (std::vector<float>& slot : factors) {
    slot.assign(steps, kNotCompared);
  }
  for (std::size_t step = 0; step < steps; ++step) {
    const auto stored = map.fingerprints(static_cast<std::int64_t>(step));
    // Left side first.
    const auto middle = std::find_if(stored.begin(), stored.end(), [&map](const Fingerprint& f) {
      return map.side_of(f) == Side::kRight;
    });
    const std::array<std::span<const Fingerprint>, 2> sides{std::span(stored.begin(), middle),
                                                            std::span(middle, stored.end())};
    for (std::size_t side = 0; side < sides.size(); ++side) {
      const std::array<float, 2> assigned = Assign(sides[side], seen[side], table);
      for (std::size_t i = 0; i < assigned.size(); ++i) {
        factors[2 * side + i][step] = assigned[i];
        if (assigned[i] >= 0) {
          moments_[2 * side + i].Add(double{assigned[i]});
        }
      }
    }
  }
}

void StepLikelihood::Combine(const Factors& factors, std::vector<float>& likelihood) const {
  likelihood.assign(factors[0].size(), 1.0F);
  for (std::size_t slot = 0; slot < kSlots; ++slot) {
    if (moments_[slot].count == 0) {
      continue;
    }
    const auto outlier = static_cast<float>(options_.outlier_share);
    const auto scale = static_cast<float>((1 - options_.outlier_share) / moments_[slot].Mean());
    for (std::size_t step = 0; step < likelihood.size(); ++step) {
      const float factor = factors[slot][step];
      likelihood[step] *= factor >= 0 ? outlier + scale * factor : 1.0F;
    }
  }
  const auto temper = static_cast<float>(options_.temper);
  for (float& value : likelihood) {
    value = std::pow(value, temper);
  }
}

// At the true step a relative factor g comes up g times as often as at any step, so its mean there
// is the mean of g squared over all steps.
double StepLikelihood::OffRoute() const {
  double off_route = 1;
  for (const Moments& moments : moments_) {
    if (moments.count > 0) {
      const double inlier = 1 - options_.outlier_share;
      const double spread = moments.MeanOfSquares() / (moments.Mean() * moments.Mean()) - 1;
      off_route *= 1 + inlier * inlier * spread;
    }
  }
  return std::pow(off_route, options_.temper * options_.off_route_share);
}

void StepLikelihood::Compute(std::span<const JourneyRef> journeys, const SeenSides& seen) {
  while (tables_.size() < journeys.size()) {
    tables_.emplace_back(journeys[tables_.size()].map->settings().deviation_model, options_.floor);
  }
  factors_.resize(journeys.size());
  likelihoods_.resize(journeys.size());
  moments_ = {};
  for (std::size_t i = 0; i < journeys.size(); ++i) {
    ComputeFactors(*journeys[i].map, tables_[i], seen, factors_[i]);
  }
  for (std::size_t i = 0; i < journeys.size(); ++i) {
    Combine(factors_[i], likelihoods_[i]);
  }
}

}  // namespace homing
