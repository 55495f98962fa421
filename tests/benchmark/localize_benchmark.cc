// One observation of two cameras localised, in one thread and without a network: with the robot's
// place known, and with every step of the map compared.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/bench/projected_drive.h"
#include "homing/journey/journey_recorder.h"
#include "homing/localization/localizer.h"
#include "tests/benchmark/benchmarks.h"

namespace homing::benchmarks {
namespace {

using client::ProjectedDrive;
using client::ProjectedWorld;

constexpr double kStepM = 4 / 3.6 / 5;
constexpr std::int64_t kKnownSteps = 2000;
// Observations until the place is surely known.
constexpr std::size_t kWarmUp = 60;
constexpr std::size_t kMeasured = 400;

Observation ObservationOf(ObservedFlow flow, std::int64_t sequence) {
  Observation observation;
  observation.sequence = sequence;
  for (std::size_t side = 0; side < flow.fields.size(); ++side) {
    if (flow.fields[side]) observation.views[side] = *std::move(flow.fields[side]);
  }
  return observation;
}

std::vector<Observation> ObservationsOf(const ProjectedDrive& drive) {
  std::vector<Observation> all;
  for (std::int64_t i = 0; i < drive.size(); ++i) {
    all.push_back(ObservationOf(drive.Flow(i), i));
  }
  return all;
}

JourneyMap MapOf(const ProjectedWorld& world, std::int64_t steps) {
  const double length = static_cast<double>(steps) * kStepM;
  const ProjectedDrive out(&world, {.seed = 1, .end_m = length});
  JourneyRecorder recorder{JourneySettings()};
  JourneyMap map;
  for (std::int64_t i = 0; i < out.size(); ++i) {
    auto step = recorder.Record(ObservationOf(out.Flow(i), i));
    if (step.ok() && *step) map.Append(**step).IgnoreError();
  }
  map.mutable_settings() = recorder.settings();
  return map;
}

// A way home from the middle of a route of `steps` steps, in `world`.
std::vector<Observation> WayHome(const ProjectedWorld& world, std::int64_t steps) {
  const double middle = static_cast<double>(steps) * kStepM / 2;
  const double length = static_cast<double>(kWarmUp + kMeasured) * kStepM;
  return ObservationsOf(ProjectedDrive(
      &world, {.seed = 2, .start_m = middle, .end_m = middle - length, .travel = Travel::kReturn}));
}

// Localises `home` on `map` again and again; the first observations of each round are not timed.
void Localise(benchmark::State& state, const JourneyMap& map, const std::vector<Observation>& home,
              Outcome expected) {
  const std::string name = "robots/r/journeys/out";
  const JourneyRef journey{&name, &map};
  LocalizerOptions options;
  options.travel = Travel::kReturn;
  std::unique_ptr<Localizer> localizer;
  std::size_t next = home.size();
  std::int64_t as_expected = 0;
  for (auto _ : state) {
    if (next == home.size()) {
      state.PauseTiming();
      localizer = std::make_unique<Localizer>(options);
      for (next = 0; next < kWarmUp; ++next) {
        localizer->Localize(home[next], {&journey, 1}).IgnoreError();
      }
      state.ResumeTiming();
    }
    const auto answer = localizer->Localize(home[next++], {&journey, 1});
    if (answer.ok() && answer->position.outcome == expected) ++as_expected;
  }
  if (as_expected < static_cast<std::int64_t>(state.iterations()) / 2) {
    state.SkipWithError("the robot is not where the benchmark needs it");
  }
}

void LocaliseKnown(benchmark::State& state) {
  const ProjectedWorld world(1, static_cast<double>(kKnownSteps) * kStepM);
  Localise(state, MapOf(world, kKnownSteps), WayHome(world, kKnownSteps), Outcome::kMatch);
}

// A robot in a foreign street: its place is not known, so that all steps are compared.
void LocaliseFull(benchmark::State& state) {
  const auto steps = state.range(0);
  const double length = static_cast<double>(steps) * kStepM;
  const ProjectedWorld world(1, length), foreign(7, length);
  Localise(state, MapOf(world, steps), WayHome(foreign, steps), Outcome::kUnknownPlace);
}

}  // namespace

void RegisterLocalizeBenchmarks(bool quick) {
  benchmark::RegisterBenchmark("localize_steady", LocaliseKnown)->Unit(benchmark::kMicrosecond);
  benchmark::RegisterBenchmark("localize_full", LocaliseFull)
      ->Arg(2000)
      ->Arg(quick ? 4000 : 10000)
      ->Unit(benchmark::kMicrosecond);
}

}  // namespace homing::benchmarks
