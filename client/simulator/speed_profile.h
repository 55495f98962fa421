// The distance driven over time if the speed varies as that of a human driver.
#ifndef CLIENT_SIMULATOR_SPEED_PROFILE_H_
#define CLIENT_SIMULATOR_SPEED_PROFILE_H_

#include <cstdint>
#include <vector>

namespace homing::client {

// Immutable.
class SpeedProfile {
 public:
  // `vary`: 0 a constant speed, 1 from kSlowest to kFastest times `speed_m_s`.
  SpeedProfile(double length_m, double speed_m_s, double vary, std::uint64_t seed);

  static constexpr double kSlowest = 0.3;
  static constexpr double kFastest = 2;

  // Duration of the whole drive.
  double DurationS() const { return TimeS(length_m_); }
  double TimeS(double driven_m) const;
  double DrivenMetres(double time_s) const;

 private:
  // m/s at a place of the drive.
  double SpeedAt(double driven_m) const;

  double length_m_;
  double speed_m_s_;
  double vary_;
  // Phases of the speed's waves.
  double slow_phase_ = 0;
  double quick_phase_ = 0;
  // Times at every kSpacingM of the drive; empty if the speed is constant.
  std::vector<double> times_s_;
};

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_SPEED_PROFILE_H_
