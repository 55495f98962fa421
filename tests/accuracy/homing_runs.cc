#include "tests/accuracy/homing_runs.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/bench/projected_drive.h"
#include "homing/journey/journey_recorder.h"
#include "homing/landmark/profile_code.h"
#include "homing/localization/localizer.h"
#include "proto/wire/enum_conversion.h"
#include "tests/accuracy/server_runs.h"

namespace homing::accuracy {
namespace {

using client::ProjectedDrive;
using client::ProjectedWorld;

Observations ObservationsOf(std::vector<const Instant*> steps) {
  const std::size_t count = steps.size();
  return {count, [steps = std::move(steps)](std::size_t i) { return steps[i]->flow; }};
}

Observations ObservationsOf(const Drive& drive) { return ObservationsOf(StepsOf(drive)); }

void Check(const absl::Status& status) {
  if (!status.ok()) Fail(status.ToString());
}

// Places of the steps of each map.
using StepPlaces = std::vector<std::vector<double>>;

StepPlaces PlacesOf(const Run& run) {
  StepPlaces places;
  for (const auto& map : run.maps) {
    places.emplace_back();
    for (const Instant* step : StepsOf(*map)) places.back().push_back(step->place);
  }
  return places;
}

double PlaceOf(const StepPlaces& places, int map, std::int64_t step) {
  return places.at(static_cast<std::size_t>(map)).at(static_cast<std::size_t>(step));
}

double OnRouteOf(const Position& position) { return 1 - position.unknown_probability; }
double OnRouteOf(const v1::LocalizeResponse& response) {
  return 1 - response.unknown_probability();
}

JourneyMap MapOf(const Observations& observations) {
  JourneyRecorder recorder({});
  JourneyMap map;
  for (std::size_t i = 0; i < observations.count; ++i) {
    auto step = recorder.Record(observations.At(i));
    Check(step.status());
    Check(map.Append(**step));
  }
  map.mutable_settings() = recorder.settings();
  return map;
}

std::string NameOf(int number, std::size_t map) {
  return absl::StrCat("robots/r", number, "/journeys/", "m", map);
}

LocalizerOptions OptionsOf(const Run& run) {
  LocalizerOptions options;
  options.travel = run.travel;
  options.position.tolerance_steps = run.tolerance_steps;
  options.match.threshold = 0;
  return options;
}

double MedianMicroseconds(const JourneyMap& map, const LocalizerOptions& options,
                          const Observations& query) {
  const std::string name = "robots/r/journeys/m";
  const JourneyRef journey{&name, &map};
  Localizer localizer(options);
  std::vector<double> times;
  for (std::size_t i = 0; i < query.count; ++i) {
    const Observation observation = query.At(i);
    const auto start = std::chrono::steady_clock::now();
    Check(localizer.Localize(observation, {&journey, 1}).status());
    times.push_back(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
            .count());
  }
  std::ranges::nth_element(times, times.begin() + std::ssize(times) / 2);
  return times[times.size() / 2];
}

Answer AnswerOf(const StepPlaces& places, const Position& position) {
  Answer answer{
      .score = position.probability, .outcome = position.outcome, .on_route = OnRouteOf(position)};
  if (position.step) {
    answer.map = position.journey;
    answer.place = PlaceOf(places, position.journey, *position.step);
  }
  return answer;
}

Answer AnswerOf(const StepPlaces& places, const std::vector<Match>& matches) {
  if (matches.empty()) return {};
  const Match& best = matches.front();
  return {.map = best.journey,
          .place = PlaceOf(places, best.journey, best.step),
          .score = best.similarity.p_t};
}

void LocalizeDirectly(int number, Run& run) {
  std::vector<JourneyMap> maps;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < run.maps.size(); ++i) {
    maps.push_back(accuracy::MapOf(*run.maps[i]));
    names.push_back(NameOf(number, i));
  }
  std::vector<JourneyRef> journeys;
  for (std::size_t i = 0; i < maps.size(); ++i) journeys.push_back({&names[i], &maps[i]});
  Localizer localizer(OptionsOf(run));
  const Observations query = ObservationsOf(run.QuerySteps());
  const StepPlaces places = PlacesOf(run);
  Answers homing;
  Answers single_frame;
  for (std::size_t i = 0; i < query.count; ++i) {
    const auto result = localizer.Localize(query.At(i), journeys);
    Check(result.status());
    homing.push_back(AnswerOf(places, result->position));
    single_frame.push_back(AnswerOf(places, result->matches));
  }
  run.homing = run.ByInstant(homing);
  run.single_frame = run.ByInstant(single_frame);
}

void LocalizeOverServer(const client::Connection& server, int number, Run& run) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < run.maps.size(); ++i) {
    names.push_back(NameOf(number, i));
    RecordOnServer(server, names.back(), ObservationsOf(*run.maps[i]));
  }
  const auto index = [&names](const std::string& name) {
    return static_cast<int>(std::ranges::find(names, name) - names.begin());
  };
  client::LocalizingOptions options;
  options.config.set_journey(names.size() == 1 ? names[0]
                                               : absl::StrCat("robots/r", number, "/journeys/-"));
  options.config.set_travel(wire::ToProto(run.travel));
  options.config.set_tolerance_steps(run.tolerance_steps);
  options.config.set_threshold(0);
  options.config.set_max_matches(1);
  const StepPlaces places = PlacesOf(run);
  Answers homing;
  Answers single_frame;
  LocalizeOnServer(server, options, ObservationsOf(run.QuerySteps()),
                   [&](const v1::LocalizeResponse& response) {
                     Answer answer{.score = response.probability(),
                                   .outcome = static_cast<Outcome>(response.outcome()),
                                   .on_route = OnRouteOf(response)};
                     if (response.has_step()) {
                       answer.map = index(response.journey());
                       answer.place = PlaceOf(places, answer.map, response.step());
                     }
                     homing.push_back(answer);
                     Answer single;
                     if (response.matches_size() > 0) {
                       single.map = index(response.matches(0).journey());
                       single.place = PlaceOf(places, single.map, response.matches(0).step());
                       single.score = response.matches(0).p_t();
                     }
                     single_frame.push_back(single);
                   });
  run.homing = run.ByInstant(homing);
  run.single_frame = run.ByInstant(single_frame);
  for (const std::string& name : names) DeleteOnServer(server, name);
}

}  // namespace

JourneyMap MapOf(const Drive& drive) { return MapOf(ObservationsOf(drive)); }

void LocalizeRun(const client::Connection* server, int number, Run& run) {
  if (server == nullptr) {
    LocalizeDirectly(number, run);
  } else {
    LocalizeOverServer(*server, number, run);
  }
}

double MicrosecondsAnObservation(const Run& run) {
  return MedianMicroseconds(MapOf(ObservationsOf(*run.maps[0])), OptionsOf(run),
                            ObservationsOf(run.QuerySteps()));
}

double MicrosecondsAtSteps(std::int64_t steps) {
  constexpr double kStepM = 4 / 3.6 / 5;
  constexpr double kQueryM = 100;
  const double length = static_cast<double>(steps) * kStepM;
  const ProjectedWorld world(1, length);
  const auto one_camera = [](const ProjectedDrive& drive) {
    return Observations{static_cast<std::size_t>(drive.size()), [&drive](std::size_t i) {
                          ObservedFlow flow = drive.Flow(static_cast<std::int64_t>(i));
                          flow.fields[1].reset();
                          return flow;
                        }};
  };
  const ProjectedDrive out(&world, {.seed = 1, .end_m = length + kStepM / 2});
  const ProjectedDrive home(&world,
                            {.seed = 2, .start_m = length / 2, .end_m = length / 2 - kQueryM});
  LocalizerOptions options;
  options.travel = Travel::kSame;
  options.match.max_matches = 1000;
  return MedianMicroseconds(MapOf(one_camera(out)), options, one_camera(home));
}

double BytesACameraStep(const Run& run) {
  constexpr double kFingerprintBytes = 16;
  const JourneyMap map = MapOf(ObservationsOf(*run.maps[0]));
  double bytes = 0;
  double camera_steps = 0;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    for (const FlowProfile& profile : map.profiles(side)) {
      bytes += static_cast<double>(EncodeProfile(profile).size());
      camera_steps += 1;
    }
  }
  for (std::int64_t step = 0; step < map.step_count(); ++step) {
    bytes += kFingerprintBytes * static_cast<double>(map.fingerprints(step).size());
  }
  return bytes / camera_steps;
}

}  // namespace homing::accuracy
