#include "tests/drive/robots.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/simulator/seeded_random.h"
#include "client/simulator/simulation_spec.h"
#include "tests/drive/local_localizer.h"
#include "tests/drive/projected_eyes.h"

namespace homing::drive {
namespace {

using client::HomeDrive;
using client::HomeDriveOptions;
using client::PosedCameras;
using client::RobotEyes;

constexpr double kRouteM = 60;
constexpr double kAtHomeM = 1;
constexpr double kStartM = 0.5;
constexpr double kStartDegrees = 10;

template <typename T>
T OrExit(absl::StatusOr<T> result) {
  if (!result.ok()) {
    std::cerr << "drive: " << result.status() << "\n";
    std::exit(1);
  }
  return *std::move(result);
}

std::unique_ptr<RobotEyes> EyesOf(const Condition& condition, const PosedCameras* cameras,
                                  double light, std::uint64_t seed) {
  if (condition.rendered) return std::make_unique<client::RenderedEyes>(cameras);
  return std::make_unique<client::ProjectedEyes>(
      cameras, client::ProjectedEyesOptions{.light = light, .seed = seed});
}

HomeDriveOptions OptionsOf(const Condition& condition, bool turns_round, std::uint64_t key) {
  client::SeededRandom random(key);
  HomeDriveOptions options;
  options.pilot.turn_round = turns_round;
  options.pilot.route_m = kRouteM;
  options.robot.seed = random.Bits();
  options.seed = random.Bits();
  options.fps = condition.home_fps;
  // Evenly over the disc.
  const double away_m = kStartM * std::sqrt(random.Uniform(0, 1));
  const double bearing = random.Uniform(0, client::kTurn);
  options.start_ahead_m = away_m * std::cos(bearing);
  options.start_left_m = away_m * std::sin(bearing);
  options.start_heading = kStartDegrees * client::kDegree * random.Uniform(-1, 1);
  options.delay_s = condition.delay_s;
  options.lost = condition.lost;
  if (condition.outage_s > 0) options.outage_at_m = random.Uniform(15, 45);
  options.outage_s = condition.outage_s;
  if (condition.carried_m > 0) options.carried_at_m = random.Uniform(15, 35);
  options.carried_m = condition.carried_m;
  options.blindfolded = condition.blindfolded;
  options.most_s = 240;
  return options;
}

Fared FaredOf(HomeDrive drive, const client::Route& route) {
  Fared fared;
  fared.end_m = drive.EndFromHome(route);
  fared.came_home = drive.stopped && fared.end_m <= kAtHomeM;
  for (const auto& point : drive.points) {
    fared.most_beside_m = std::max(fared.most_beside_m, std::abs(point.left_m));
    if (point.state != client::Pilot::State::kTurningRound) {
      fared.beside_m.push_back(std::abs(point.left_m));
    }
  }
  fared.drive = std::move(drive);
  return fared;
}

}  // namespace

Fared DriveOne(const Condition& condition, int index, int world) {
  const bool is_street = index % 2 == 0;
  const bool turns_round = index / 2 % 2 == 0;
  const std::string scene =
      absl::StrCat("sim:", is_street ? "street" : "landmarks", ",length=", kRouteM, ",seed=", world,
                   condition.route_keys);
  const auto out = OrExit(PosedCameras::Create(OrExit(client::ParseSimulationSpec(scene))));
  const auto home = OrExit(PosedCameras::Create(
      OrExit(client::ParseSimulationSpec(absl::StrCat(scene, ",drive=7", condition.home_keys)))));
  const auto out_eyes = EyesOf(condition, out.get(), 1, 1);
  const auto home_eyes = EyesOf(condition, home.get(), condition.light, 2);
  const JourneyMap map = OrExit(RecordOut(out->route(), {}, out_eyes.get()));
  LocalLocalizer localizer(&map, turns_round ? Travel::kReturn : Travel::kSame);
  const auto key = client::Mix(static_cast<std::uint64_t>(world), 95);
  HomeDrive drive = OrExit(client::DriveHome(
      OptionsOf(condition, turns_round, key), out->route(), home_eyes.get(),
      [&](const Observation& seen) { return localizer.Answer(seen); },
      [&] { return localizer.Restart(); }));
  return FaredOf(std::move(drive), out->route());
}

}  // namespace homing::drive
