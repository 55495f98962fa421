// How well the steps of the journeys fit the flow profiles seen at one instant: likelihood ratios
// against a place at random. Source: own design; fitted to matched and unmatched pairs (docs/
// algorithm.md).
#ifndef HOMING_PROFILE_PROFILE_LIKELIHOOD_H_
#define HOMING_PROFILE_PROFILE_LIKELIHOOD_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "homing/journey/journey_ref.h"
#include "homing/profile/path_offsets.h"
#include "homing/profile/profile_distance.h"
#include "homing/profile/profile_evidence.h"
#include "homing/profile/profile_views.h"
#include "homing/profile/step_mass.h"

namespace homing {

// Learns the offset from the outbound path on the way. Not thread-safe.
class ProfileLikelihood {
 public:
  ProfileLikelihood();

  // Some journey has profiles of a side that is seen.
  static bool CanCompare(std::span<const JourneyRef> journeys, const SeenProfiles& seen);

  // `predicted`: by journey, the mass of its steps, or of those of its focus, before this instant.
  // REQUIRES: CanCompare. Computing again, for other steps, is no further observation.
  void Compute(std::span<const JourneyRef> journeys, const SeenProfiles& seen,
               std::span<const StepMass> predicted);
  // Ends the instant: takes up what it says of the offset.
  void Learn();

  // By predicted step. Sides without profiles are neutral: 1.
  std::span<const float> of(std::size_t journey) const { return likelihoods_[journey]; }
  // Mean over the predicted mass, logarithm, for one side.
  double LogFit() const;
  // The value of being off the route, logarithm, for one side.
  double OffRoute() const;
  // Sides that were compared: 1 or 2.
  int sides() const { return (compared_[0] ? 1 : 0) + (compared_[1] ? 1 : 0); }

 private:
  static constexpr std::size_t kViews = kPathOffsets.size();
  // Of one side and view, by journey and predicted step; empty where the journey has no profiles.
  using Distances = std::vector<std::vector<std::uint16_t>>;
  struct SeenView {
    std::size_t view = 0;
    FlowProfile profile;
  };

  void Choose(std::span<const JourneyRef> journeys, std::span<const StepMass> predicted);
  void Measure(std::span<const JourneyRef> journeys, Side side, const ProfileMaker& seen,
               std::span<const StepMass> predicted);
  // What the chosen offsets make of one side.
  std::vector<SeenView> ViewsOf(std::size_t side, const ProfileMaker& seen) const;
  // Multiplies the factors of one side's view into `factors`.
  void Multiply(std::size_t side, std::size_t view, std::size_t journey,
                std::vector<float>& factors) const;
  void Weigh(std::span<const StepMass> predicted);
  // Adds what `factors_` say of one offset to a journey's likelihoods and fits.
  void AddOffset(std::size_t offset, std::size_t journey, const StepMass& predicted);
  // Probability of the offset if the robot is in the stretch, of those that are tried.
  float WeightOf(std::size_t offset, std::size_t journey, std::size_t stretch) const;

  std::array<CellMask, kViews> covered_;
  std::array<std::array<Distances, kViews>, 2> distances_;
  std::array<std::array<DistanceScale, kViews>, 2> scales_;
  // EvidenceWeight of each side.
  std::array<int, 2> weights_{};
  std::array<bool, 2> compared_{};
  // Offsets that are tried at this instant.
  std::array<bool, kViews> chosen_{};
  // Instants compared before this one.
  std::int64_t instants_ = 0;
  // By journey.
  std::vector<PathOffsets> offsets_;
  // Probability of each offset, wherever the robot is.
  OffsetValues anywhere_;
  // By journey and stretch that holds a predicted step: predicted mass times factor.
  std::vector<std::vector<OffsetValues>> fits_;
  // By journey: the first of them.
  std::vector<std::size_t> first_stretch_;
  // Mean over the predicted mass.
  double mean_fit_ = 0;
  std::vector<float> factors_;
  std::vector<std::vector<float>> likelihoods_;
};

}  // namespace homing

#endif  // HOMING_PROFILE_PROFILE_LIKELIHOOD_H_
