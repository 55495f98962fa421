// Belief over the steps of one journey, the direction along it and the speed relative to the
// outbound trip; and the motion model (Bayesian statistics are the paper's future work, V).
#ifndef HOMING_LOCALIZATION_ROUTE_BELIEF_H_
#define HOMING_LOCALIZATION_ROUTE_BELIEF_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "homing/localization/speed_evidence.h"
#include "homing/profile/step_mass.h"

namespace homing {

// Masses are not normalised. Once the robot's place is known, only the steps around it are held one
// by one (the active window); all others have the same small mass. Not thread-safe.
class RouteBelief {
 public:
  std::int64_t step_count() const { return step_count_; }
  // The active window: focus_size() steps from first_step() on. At first all steps.
  std::int64_t first_step() const { return first_; }
  std::int64_t focus_size() const { return static_cast<std::int64_t>(ways_[0].size()); }
  bool IsFocused() const { return focus_size() < step_count_; }

  // Appends steps, each with `mass` spread over directions and speeds like the prior; with the mass
  // of the steps outside of the active window if there are such steps.
  void Grow(std::int64_t step_count, double mass);
  // Adds `mass` to each step, spread in the same way.
  void AddToEach(double mass);
  // Adds `mass`, spread over the steps `first` to `last` of the journey and over one direction or
  // both. REQUIRES: all steps are held one by one; one of the steps is of the journey.
  struct Place {
    std::int64_t first = 0;
    std::int64_t last = 0;
    bool homeward = true;
    bool outward = true;
    double mass = 0;
  };
  void Add(const Place& place);

  // Moves the masses by one observation of motion; each step then gains `restart`. `change`:
  // probability that the speed changes. Mass that passes an end of the journey leaves it: returns
  // that fraction.
  double Move(double change, double restart = 0);
  // The same for the way between two observations that the flow does not show: several steps, each
  // at any speed.
  double MoveUnseen(double restart);
  // Moves the masses by a turn on the spot: hardly any motion.
  void Turn(double restart = 0);
  // Multiplies each step of the active window by its factor, each direction by its factor, and each
  // speed by the odometer's likelihood. `ratios`: SpeedEvidence::IndexOf the reading now less the
  // step's. `directions`: DirectionFactors. REQUIRES: focus_size() factors and ratios. Returns the
  // remaining mass.
  StepMass Weigh(std::span<const float> factors, std::span<const std::int16_t> ratios,
                 const SpeedEvidence& speeds, const std::array<double, 2>& directions);
  void Scale(double factor);

  // Holds only steps of at least `least` mass, and those between them, one by one.
  void Focus(double least, const StepMass& mass);
  // Holds all steps one by one.
  void Unfocus();

  double Mass() const;
  // Masses of the active window.
  StepMass Masses() const;
  double MassWithin() const;
  // Mass of all steps outside of the active window.
  double MassBeyond() const;
  // Mean speed of the active window, steps an observation, and with its sign away from home.
  struct Speed {
    double absolute = 0;
    double outward = 0;
  };
  // After the last Weigh.
  const Speed& mean_speed() const { return mean_speed_; }
  // Mass from `first` to `last` that moves towards home (0), away from it (1).
  std::array<double, 2> DirectionMass(std::int64_t first, std::int64_t last) const;

 private:
  // Towards home, away from home.
  static constexpr std::size_t kLanes = 2 * kSpeedCount;
  using Lane = std::vector<float>;
  struct Motion;

  // The steps from which and to which a motion carries the lanes.
  struct Carried;

  // The probabilities that the speed changes to a neighbouring one, and to any.
  double MoveMixing(double to_neighbours, double to_any, double restart);

  void Carry(const Motion& motion, double restart);
  // Copies a lane, mixed with its neighbours, with what lies on either side of the steps of
  // `carried`, into `mixed`. `slower`: the lane of the speed before, as it was.
  void Mix(std::size_t lane, const Motion& motion, const Carried& carried,
           std::span<const float> slower, Lane& mixed) const;
  // Moves a mixed lane to where it is now.
  void MoveMixed(std::size_t lane, const Motion& motion, double restart, const Lane& mixed,
                 std::span<float> moved) const;
  float Beyond(std::int64_t step) const;
  std::span<float> LaneOf(std::size_t lane) {
    return std::span(lanes_).subspan(lane * ways_[0].size(), ways_[0].size());
  }
  std::span<const float> LaneOf(std::size_t lane) const {
    return std::span(lanes_).subspan(lane * ways_[0].size(), ways_[0].size());
  }
  // Holds the `size` steps from `first` on one by one. Those that are new get `mass`.
  void Hold(std::int64_t first, std::int64_t size, double mass);

  std::int64_t step_count_ = 0;
  std::int64_t first_ = 0;
  // Masses by lane, and by step from first_ on. In one piece, which is given back when the place is
  // known: of many small pieces some would stay in use in each page.
  std::vector<float> lanes_;
  // Sums of the lanes of each direction: other loops need not go through all lanes.
  std::array<Lane, 2> ways_;
  Speed mean_speed_;
  // Mass of each step outside of the active window.
  double background_ = 0;
  // All masses are still to be multiplied by this.
  double scale_ = 1;
};

}  // namespace homing

#endif  // HOMING_LOCALIZATION_ROUTE_BELIEF_H_
