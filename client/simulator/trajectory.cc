#include "client/simulator/trajectory.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "client/simulator/seeded_random.h"

namespace homing::client {
namespace {

// Wave lengths of the wobble along the drive, and its yaw for a metre of sway.
constexpr double kSwayPeriodM = 17;
constexpr double kYawPeriodM = 11;
constexpr double kYawRadPerMetre = 0.05;
// Wave lengths of the steering along the drive.
constexpr double kLongSteeringM = 6.1;
constexpr double kShortSteeringM = 3.7;

}  // namespace

Trajectory::Trajectory(const SimulationSpec& spec, std::uint64_t drive_seed)
    : spec_(spec),
      drive_seed_(drive_seed),
      length_m_(spec.length_m + spec.extra_m),
      speed_(length_m_, spec.speed_kmh / 3.6, spec.vary, drive_seed) {
  SeededRandom random(Mix(drive_seed, 77));
  sway_phase_ = random.Uniform(0, kTurn);
  yaw_phase_ = random.Uniform(0, kTurn);
  long_phase_ = random.Uniform(0, kTurn);
  short_phase_ = random.Uniform(0, kTurn);
}

std::int64_t Trajectory::frame_count() const {
  const double duration_s = speed_.DurationS() + spec_.stop_s;
  // The margin counts a frame at the very end in spite of rounding.
  return static_cast<std::int64_t>(duration_s * spec_.fps + 1e-6) + 1;
}

double Trajectory::TimeS(std::int64_t frame) const {
  return static_cast<double>(frame) / spec_.fps;
}

double Trajectory::DrivenMetres(double time_s) const {
  const double half_s = speed_.TimeS(0.5 * length_m_);
  const double moving_s = std::min(time_s, half_s) + std::max(0.0, time_s - half_s - spec_.stop_s);
  return speed_.DrivenMetres(moving_s);
}

double Trajectory::RouteMetres(std::int64_t frame) const {
  const double driven_m = DrivenMetres(TimeS(frame));
  return spec_.travel_return ? spec_.length_m - driven_m : driven_m;
}

Pose Trajectory::At(std::int64_t frame, const Route& route) const {
  const double route_m = RouteMetres(frame);
  Pose pose = route.At(route_m);
  const double sway_m = spec_.wobble_m * std::sin(kTurn * route_m / kSwayPeriodM + sway_phase_);
  pose.position = pose.At(0, spec_.offset_m + sway_m);
  pose.heading +=
      kYawRadPerMetre * spec_.wobble_m * std::sin(kTurn * route_m / kYawPeriodM + yaw_phase_);
  Steer(route_m, pose);
  return pose;
}

void Trajectory::Steer(double route_m, Pose& pose) const {
  if (spec_.yaw_wobble_deg == 0) {
    return;
  }
  const double most = spec_.yaw_wobble_deg * kDegree;
  double yaw = 0;
  double left_m = 0;
  for (const auto& [share, period_m, phase] : {std::tuple(0.6, kLongSteeringM, long_phase_),
                                               std::tuple(0.4, kShortSteeringM, short_phase_)}) {
    const double angle = kTurn * route_m / period_m + phase;
    yaw += share * most * std::sin(angle);
    // The integral of the heading along the route.
    left_m -= share * most * period_m / kTurn * std::cos(angle);
  }
  pose.position = pose.At(0, left_m);
  pose.heading += yaw;
}

Trajectory::Jolt Trajectory::JoltAt(std::int64_t frame) const {
  if (spec_.rough_deg == 0) {
    return {};
  }
  SeededRandom random(Mix(drive_seed_, 81, static_cast<std::uint64_t>(frame)));
  const double most = spec_.rough_deg * kDegree;
  const double roll = random.Uniform(-most, most);
  const double pitch = random.Uniform(-most, most);
  return {roll, pitch, 0.01 * spec_.rough_deg * random.Uniform(-1, 1)};
}

}  // namespace homing::client
