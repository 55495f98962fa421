#include "tests/accuracy/fleet.h"

#include <cmath>
#include <iostream>
#include <mutex>
#include <string>
#include <vector>

#include "absl/strings/str_format.h"
#include "client/bench/projected_drive.h"
#include "client/simulator/seeded_random.h"
#include "proto/wire/enum_conversion.h"
#include "tests/accuracy/parallel.h"
#include "tests/accuracy/server_runs.h"

namespace homing::accuracy {
namespace {

using client::ProjectedDrive;
using client::ProjectedDriveOptions;
using client::ProjectedWorld;

constexpr double kOutKmh = 4;
constexpr double kHomeKmh = 5;
constexpr double kFps = 5;
constexpr double kAsideM = 0.5;

std::string NameOf(std::size_t journey) {
  return absl::StrFormat("robots/fleet/journeys/j%04d", journey);
}

Observations ObservationsOf(const ProjectedDrive& drive) {
  return {static_cast<std::size_t>(drive.size()),
          [&drive](std::size_t i) { return drive.Flow(static_cast<std::int64_t>(i)); }};
}

ProjectedDrive WayOut(const ProjectedWorld& world, std::size_t journey, double length_m) {
  ProjectedDriveOptions options;
  options.seed = 2 * journey + 1;
  options.end_m = length_m;
  options.speed_kmh = kOutKmh;
  options.fps = kFps;
  return ProjectedDrive(&world, options);
}

ProjectedDrive WayHome(const ProjectedWorld& world, std::size_t journey,
                       const FleetOptions& fleet) {
  client::SeededRandom random(client::Mix(0xF1EE7, journey));
  ProjectedDriveOptions options;
  options.seed = 2 * journey + 2;
  options.start_m = random.Uniform(fleet.driven_m + 2, fleet.length_m);
  options.end_m = options.start_m - fleet.driven_m - 1;
  options.speed_kmh = kHomeKmh;
  options.fps = kFps;
  options.offset_m = kAsideM;
  options.travel = Travel::kReturn;
  return ProjectedDrive(&world, options);
}

}  // namespace

FleetResult RunFleet(const client::Connection& server, const FleetOptions& fleet) {
  const auto count = static_cast<std::size_t>(fleet.journeys);
  std::vector<std::vector<double>> places(count);
  InParallel(count, [&](std::size_t j) {
    const ProjectedWorld world(j + 1, fleet.length_m);
    const ProjectedDrive out = WayOut(world, j, fleet.length_m);
    RecordOnServer(server, NameOf(j), ObservationsOf(out));
    for (std::int64_t i = 0; i < out.size(); ++i) places[j].push_back(out.Place(i));
  });
  FleetResult result{.robots = fleet.journeys};
  std::mutex mutex;
  InParallel(count, [&](std::size_t j) {
    const ProjectedWorld world(j + 1, fleet.length_m);
    const ProjectedDrive home = WayHome(world, j, fleet);
    client::LocalizingOptions options;
    options.config.set_journey("robots/fleet/journeys/-");
    options.config.set_travel(wire::ToProto(Travel::kReturn));
    v1::LocalizeResponse last;
    LocalizeOnServer(
        server, options, ObservationsOf(home), [&](const v1::LocalizeResponse& answer) {
          if (std::abs(home.Place(answer.sequence()) - home.Place(0)) <= fleet.driven_m)
            last = answer;
        });
    const bool right = last.has_step() && last.journey() == NameOf(j) &&
                       std::abs(places[j].at(static_cast<std::size_t>(last.step())) -
                                home.Place(last.sequence())) <= fleet.tolerance_m;
    const std::lock_guard lock(mutex);
    if (!right) {
      std::cerr << absl::StrFormat("fleet: %s at %.1f m taken for %s, step %d, probability %.2f\n",
                                   NameOf(j), home.Place(last.sequence()), last.journey(),
                                   last.has_step() ? last.step() : -1, last.probability());
    }
    result.right += right ? 1 : 0;
    result.sure += right && last.outcome() == v1::OUTCOME_MATCH ? 1 : 0;
  });
  for (std::size_t j = 0; j < count; ++j) DeleteOnServer(server, NameOf(j));
  return result;
}

}  // namespace homing::accuracy
