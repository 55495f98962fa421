// Likelihood of the steps of the journeys by the landmarks seen at one instant: P_T of up to four
// landmarks, assigned one to one within a side. Source: paper III, V for P_T.
#ifndef HOMING_LOCALIZATION_STEP_LIKELIHOOD_H_
#define HOMING_LOCALIZATION_STEP_LIKELIHOOD_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/status.h"
#include "homing/matching/matcher.h"
#include "homing/profile/factor_table.h"

namespace homing {

struct LikelihoodOptions {
  // Least P_T of a landmark. (0, 1).
  double floor = 1e-3;
  // Probability that a landmark is not the one in the map (hidden, new, divided otherwise). [0, 1].
  double outlier_share = 0.6;
  // Exponent of the whole likelihood: consecutive frames are not independent. (0, 1].
  double temper = 0.25;
  // Value of being off the route between that of a random step (0) and that of the true step (1),
  // as logarithms. [0, 1].
  double off_route_share = 0.4;
};

absl::Status Validate(const LikelihoodOptions& options);

// Keeps its tables from call to call. Not thread-safe.
class StepLikelihood {
 public:
  // REQUIRES: Validate(options).ok().
  explicit StepLikelihood(const LikelihoodOptions& options) : options_(options) {}

  // Both as in PositionFilter::Update.
  void Compute(std::span<const JourneyRef> journeys, const SeenSides& seen);

  // One value a step: the product of its landmarks' factors. A factor is P_T over its mean over all
  // steps of all journeys with a landmark to compare, or 1 if it is an outlier. Without a landmark
  // to compare it is neutral: 1.
  const std::vector<float>& of(std::size_t journey) const { return likelihoods_[journey]; }
  // The value of being off the route: between that of a random step, 1, and the expected value of
  // the true step.
  double OffRoute() const;

 private:
  // Two landmarks a side of the route.
  static constexpr std::size_t kSlots = 4;
  // Factors of one landmark by step; below 0: not compared.
  using Factors = std::array<std::vector<float>, kSlots>;
  struct Moments {
    double sum = 0;
    double squares = 0;
    std::int64_t count = 0;

    void Add(double value) {
      sum += value;
      squares += value * value;
      ++count;
    }
    double Mean() const { return sum / static_cast<double>(count); }
    double MeanOfSquares() const { return squares / static_cast<double>(count); }
  };

  void ComputeFactors(const JourneyMap& map, const FactorTable& table, const SeenSides& seen,
                      Factors& factors);
  void Combine(const Factors& factors, std::vector<float>& likelihood) const;

  LikelihoodOptions options_;
  // Tables by journey.
  std::vector<FactorTable> tables_;
  std::vector<Factors> factors_;
  std::vector<std::vector<float>> likelihoods_;
  std::array<Moments, kSlots> moments_;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_STEP_LIKELIHOOD_H_
