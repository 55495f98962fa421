// How well the steps of the journeys fit the flow profiles seen at one instant: likelihood ratios
// against a place at random (docs/algorithm.md).
#ifndef HOMING_PROFILE_PROFILE_LIKELIHOOD_H_
#define HOMING_PROFILE_PROFILE_LIKELIHOOD_H_

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "homing/journey/journey_ref.h"
#include "homing/profile/path_offsets.h"
#include "homing/profile/profile_distance.h"
#include "homing/profile/profile_evidence.h"
#include "homing/profile/profile_views.h"
#include "homing/profile/route_scale.h"
#include "homing/profile/shared_change.h"
#include "homing/profile/step_mass.h"

namespace homing {

// Estimates the offset from the outbound path at the same time. Not thread-safe.
class ProfileLikelihood {
 public:
  // True if some journey has profiles of a side that the robot sees with enough vectors.
  static bool CanCompare(std::span<const JourneyRef> journeys, const SeenProfiles& seen);

  // Measures journeys that are new or have grown much.
  void Grow(std::span<const JourneyRef> journeys);
  // The scale of each journey.
  Routes routes() const { return routes_; }

  // `predicted`: by journey, the mass of its steps, or of those of its active window, before this
  // instant. `weight`: of this observation, (0, 1]; 1 if it depends on nothing seen before.
  // REQUIRES: Grow(journeys) and CanCompare. Computing again, for other steps, is no further
  // observation.
  void Compute(std::span<const JourneyRef> journeys, const SeenProfiles& seen,
               std::span<const StepMass> predicted, double weight);
  // Ends the instant: updates the belief about the offset.
  void Learn();

  // Frees what only this instant needed: few of a thousand robots compare at the same time.
  // REQUIRES: no of() and no Believed() until the next Compute.
  void Release();

  // Likelihood ratio by predicted step. Sides without profiles are neutral: 1.
  std::span<const float> of(std::size_t journey) const { return likelihoods_[journey]; }
  // Sides that were compared.
  int compared() const { return (compared_[0] ? 1 : 0) + (compared_[1] ? 1 : 0); }
  // The views of this instant at the likeliest of the steps `first` to `last`. REQUIRES: some of
  // these steps are predicted.
  BelievedInstant Believed(std::size_t journey, std::int64_t first, std::int64_t last) const;
  // Starts with the robot at this offset, as MeanOffset gives it.
  void StartAtOffset(double offset);
  // Posterior mean of the offset to the left of the route, in scene distances (profile_views.h).
  double MeanOffset() const;

 private:
  static constexpr std::size_t kViews = kPathOffsets.size();
  // Distances of one side and view, by journey and predicted step; empty if the journey has no
  // profiles.
  using Distances = std::vector<std::vector<std::uint16_t>>;
  struct SeenView {
    std::size_t view = 0;
    FlowProfile profile;
  };

  // Of the offsets, or of the headings.
  struct Belief {
    // By journey.
    std::vector<PathOffsets> offsets;
    // Wherever the robot is.
    OffsetValues anywhere = PathOffsets::Prior();
  };

  Belief& belief() { return beliefs_[static_cast<std::size_t>(seeing_)]; }
  const Belief& belief() const { return beliefs_[static_cast<std::size_t>(seeing_)]; }
  const OffsetValues& anywhere() const { return belief().anywhere; }
  std::size_t LikeliestOffset() const;
  void Choose(std::span<const JourneyRef> journeys, std::span<const StepMass> predicted);
  void Measure(std::span<const JourneyRef> journeys, Side side, const ProfileMaker& seen,
               std::span<const StepMass> predicted);
  // The views of one side under the chosen offsets.
  std::vector<SeenView> ViewsOf(std::size_t side, const ProfileMaker& seen) const;
  // Multiplies the factors of one side's view into `factors`.
  void Multiply(std::size_t side, std::size_t view, std::size_t journey, std::int64_t first,
                std::vector<float>& factors) const;
  void Weigh(std::span<const StepMass> predicted);
  // Adds `factors_`, computed under one offset, to a journey's likelihoods and fits.
  void AddOffset(std::size_t offset, std::size_t journey, const StepMass& predicted);
  // Probability of the offset among the tried ones, if the robot is in the stretch.
  float WeightOf(std::size_t offset, std::size_t journey, std::size_t stretch) const;

  // Views of this instant, by side.
  std::array<std::vector<SeenView>, 2> views_;
  std::array<std::array<Distances, kViews>, 2> distances_;
  std::array<std::array<DistanceScale, kViews>, 2> scales_;
  std::array<bool, 2> compared_{};
  Seeing seeing_ = Seeing::kBothSides;
  // Offsets that are tried at this instant.
  std::array<bool, kViews> chosen_{};
  // Instants compared before this one.
  std::int64_t instants_ = 0;
  std::array<Belief, 2> beliefs_;
  // Predicted mass times factor, by journey and by stretch that holds a predicted step.
  std::vector<std::vector<OffsetValues>> fits_;
  // By journey: the first of these stretches.
  std::vector<std::size_t> first_stretch_;
  // Scales by journey: as measured, and extended to the steps added since.
  std::vector<std::shared_ptr<const RouteScale>> measured_;
  std::vector<std::shared_ptr<const RouteScale>> routes_;
  // Steps of each when it was extended.
  std::vector<std::int64_t> extended_;
  // First predicted step.
  std::vector<std::int64_t> first_steps_;
  // Weight of this observation.
  double weight_ = 1;
  std::vector<float> factors_;
  std::vector<std::vector<float>> likelihoods_;
};

}  // namespace homing

#endif  // HOMING_PROFILE_PROFILE_LIKELIHOOD_H_
