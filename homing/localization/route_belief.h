// Belief over the steps of one journey, the direction along it and the speed relative to the
// outbound trip; and the motion model that carries it on. Source: own design (Bayesian statistics
// are the paper's future work, V).
#ifndef HOMING_LOCALIZATION_ROUTE_BELIEF_H_
#define HOMING_LOCALIZATION_ROUTE_BELIEF_H_

#include <array>
#include <cstdint>
#include <vector>

namespace homing {

// Masses are not normalised. Not thread-safe.
class RouteBelief {
 public:
  // Steps of the journey a step of the way home: powers of the fourth root of 2.
  static constexpr std::array<double, 11> kSpeeds = {0.35355, 0.5,     0.59460, 0.70711, 0.84090, 1,
                                                     1.18921, 1.41421, 1.68179, 2,       2.82843};

  std::int64_t step_count() const { return step_count_; }
  // Takes up steps at the end, each with `mass` spread over directions and speeds as the prior is.
  void Grow(std::int64_t step_count, double mass);
  // Adds `mass` to each step, spread in the same way.
  void AddToEach(double mass);

  // One step of motion. What runs off an end of the journey is gone.
  void Move();
  // A turn on the spot: hardly any motion.
  void Turn();
  // Times one factor a step. REQUIRES: as many as steps.
  void Weigh(const std::vector<float>& factors);
  void Scale(double factor);

  double Mass() const;
  // Mass by step, over all directions and speeds.
  std::vector<double> StepMass() const;
  // Mass from `first` to `last` that moves towards home (0), away from it (1).
  std::array<double, 2> DirectionMass(std::int64_t first, std::int64_t last) const;

 private:
  // Towards home, away from home.
  static constexpr std::size_t kLanes = 2 * kSpeeds.size();
  using Lane = std::vector<float>;

  void MixInto(std::size_t lane, Lane& mixed) const;

  std::int64_t step_count_ = 0;
  std::array<Lane, kLanes> lanes_;
  std::array<Lane, kLanes> moved_;
  Lane mixed_;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_ROUTE_BELIEF_H_
