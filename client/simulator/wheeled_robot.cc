#include "client/simulator/wheeled_robot.h"

#include <cmath>

#include "client/simulator/seeded_random.h"

namespace homing::client {
namespace {

// The two waves of a wheel's slip, s.
constexpr std::array<std::array<double, 2>, 2> kSlipPeriodS = {{{7.3, 3.1}, {8.9, 2.7}}};

}  // namespace

WheeledRobot::WheeledRobot(const WheeledRobotOptions& options, const Pose& start)
    : options_(options), pose_(start) {
  SeededRandom random(Mix(options.seed, 91));
  for (auto& wheel : phases_) {
    for (double& phase : wheel) phase = random.Uniform(0, kTurn);
  }
}

void WheeledRobot::Drive(const Command& command, double seconds) {
  const auto ticks = std::lround(seconds / kTickS);
  for (long i = 0; i < ticks; ++i) Tick(command);
}

double WheeledRobot::SlipOf(std::size_t wheel) const {
  double waves = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    waves += 0.5 * std::sin(kTurn * time_s() / kSlipPeriodS[wheel][i] + phases_[wheel][i]);
  }
  return options_.slip * (0.5 + 0.5 * waves);
}

void WheeledRobot::Tick(const Command& command) {
  const double share = options_.lag_s > 0 ? 1 - std::exp(-kTickS / options_.lag_s) : 1;
  motion_.speed_mps += share * (command.speed_mps - motion_.speed_mps);
  motion_.turn_rate += share * (command.turn_rate - motion_.turn_rate);
  const auto noise_number = static_cast<std::uint64_t>(time_s() * WheeledRobotOptions::kNoiseHz);
  SeededRandom random(Mix(options_.seed, 92, noise_number));
  const double speed = motion_.speed_mps * (1 + options_.noise * random.Gaussian());
  const double turn_rate = motion_.turn_rate * (1 + options_.noise * random.Gaussian());
  const double half_track_m = 0.5 * options_.track_m;
  const double left = (speed - half_track_m * turn_rate) * (1 - SlipOf(0));
  const double right = (speed + half_track_m * turn_rate) * (1 - SlipOf(1));
  const double turned = (right - left) / options_.track_m * kTickS;
  pose_.heading += 0.5 * turned;
  pose_.position += 0.5 * (left + right) * kTickS * pose_.Along();
  pose_.heading += 0.5 * turned;
  ++ticks_;
}

}  // namespace homing::client
