#include "client/simulator/trajectory.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "client/simulator/seeded_random.h"

namespace homing::client {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
// Wave lengths of the wobble along the drive, and its yaw for a metre of sway.
constexpr double kSwayPeriodM = 17;
constexpr double kYawPeriodM = 11;
constexpr double kYawRadPerMetre = 0.05;

}  // namespace

Trajectory::Trajectory(const SimulationSpec& spec, std::uint64_t drive_seed)
    : spec_(spec), speed_m_s_(spec.speed_kmh / 3.6) {
  SeededRandom random(Mix(drive_seed, 77));
  sway_phase_ = random.Uniform(0, kTurn);
  yaw_phase_ = random.Uniform(0, kTurn);
}

std::int64_t Trajectory::frame_count() const {
  const double duration_s = spec_.length_m / speed_m_s_ + spec_.stop_s;
  // A frame that falls on the end but for rounding is on it.
  return static_cast<std::int64_t>(duration_s * spec_.fps + 1e-6) + 1;
}

double Trajectory::TimeS(std::int64_t frame) const {
  return static_cast<double>(frame) / spec_.fps;
}

double Trajectory::DrivenMetres(double time_s) const {
  const double half_s = 0.5 * spec_.length_m / speed_m_s_;
  const double moving_s = std::min(time_s, half_s) + std::max(0.0, time_s - half_s - spec_.stop_s);
  return std::clamp(moving_s * speed_m_s_, 0.0, spec_.length_m);
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
  return pose;
}

}  // namespace homing::client
