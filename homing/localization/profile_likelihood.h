// How well the steps of the journeys fit the flow profiles seen at one instant: likelihood ratios
// against a place at random. Source: own design; fitted to matched and unmatched pairs (docs/
// algorithm.md).
#ifndef HOMING_LOCALIZATION_PROFILE_LIKELIHOOD_H_
#define HOMING_LOCALIZATION_PROFILE_LIKELIHOOD_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "homing/localization/matcher.h"
#include "homing/localization/profile_distance.h"
#include "homing/localization/profile_evidence.h"
#include "homing/localization/profile_views.h"

namespace homing {

// Learns the offset from the outbound path on the way. Not thread-safe.
class ProfileLikelihood {
 public:
  ProfileLikelihood();

  // Some journey has profiles of a side that is seen.
  static bool CanCompare(std::span<const JourneyRef> journeys, const SeenProfiles& seen);

  // `predicted`: by journey, the mass of each step before this instant. REQUIRES: as many steps as
  // the journeys have; CanCompare.
  void Compute(std::span<const JourneyRef> journeys, const SeenProfiles& seen,
               std::span<const std::vector<double>> predicted);

  // By step. Sides without profiles are neutral: 1.
  const std::vector<float>& of(std::size_t journey) const { return likelihoods_[journey]; }
  // The value of being off the route, logarithm.
  double OffRoute() const { return off_route_; }

 private:
  static constexpr std::size_t kViews = kPathOffsets.size();
  // Of one side and view, by journey and step; empty where the journey has no profiles.
  using Distances = std::vector<std::vector<std::uint16_t>>;

  void Measure(std::span<const JourneyRef> journeys, std::size_t side, const ProfileViews& seen);
  DistanceScale ScaleOfAll(const Distances& distances);
  // Multiplies the factors of one side's view into `factors`.
  void Multiply(std::size_t side, std::size_t view, std::size_t journey,
                std::vector<float>& factors) const;
  void Weigh(std::span<const std::vector<double>> predicted);

  std::array<CellMask, kViews> covered_;
  std::array<std::array<Distances, kViews>, 2> distances_;
  std::array<std::array<DistanceScale, kViews>, 2> scales_;
  std::array<bool, 2> compared_{};
  // Nothing has been compared before this instant.
  bool first_ = true;
  double off_route_ = 0;
  // Probability of each offset from the outbound path.
  std::array<double, kViews> offsets_{};
  std::vector<float> factors_;
  std::vector<float> sample_;
  std::vector<std::vector<float>> likelihoods_;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_PROFILE_LIKELIHOOD_H_
