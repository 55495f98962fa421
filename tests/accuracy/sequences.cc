#include "tests/accuracy/sequences.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <random>
#include <thread>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"

namespace homing::accuracy {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> FilesOf(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

std::vector<double> Numbers(std::size_t count) {
  std::vector<double> numbers(count);
  for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<double>(i);
  return numbers;
}

Run MakeRun(const std::string& set, std::shared_ptr<const Drive> map,
            std::shared_ptr<const Drive> query) {
  Run run;
  run.set = set;
  run.maps = {std::move(map)};
  for (const Instant& instant : *query) run.query.push_back(&instant);
  run.query_drive = std::move(query);
  return run;
}

std::shared_ptr<const Drive> Share(Drive drive) {
  return std::make_shared<const Drive>(std::move(drive));
}

// Lap 2's frame and the frame of lap 1 at the same place.
std::vector<double> PlacesOfLap2(const std::string& match_csv, std::size_t frames) {
  std::vector<double> places(frames, kUnknown);
  std::ifstream file(match_csv);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    const std::vector<std::string> parts = absl::StrSplit(line, ',');
    places.at(std::stoul(parts.at(1))) = std::stod(parts.at(0));
  }
  return places;
}

void AddLaps(const std::string& data, std::vector<Run>& runs) {
  const auto lap1 = FilesOf(data + "/laps/lap1");
  const auto map = Share(DriveOfFiles(lap1, Numbers(lap1.size())));
  for (const auto& [folder, set] : {std::pair("lap2", "laps"), std::pair("lap2_dim", "laps dim")}) {
    const auto files = FilesOf(data + "/laps/" + folder);
    const auto places = PlacesOfLap2(data + "/laps/match.csv", files.size());
    Run run = MakeRun(set, map, Share(DriveOfFiles(files, places)));
    run.tolerance = 10;
    run.tolerance_steps = 10;
    runs.push_back(std::move(run));
  }
}

// Row i is the map of rows i + 1 and i + 2, forth and back.
void AddRows(const std::string& folder, const std::string& set, std::vector<Run>& runs) {
  std::vector<std::shared_ptr<const Drive>> forth;
  std::vector<std::shared_ptr<const Drive>> back;
  for (const std::string& row : FilesOf(folder)) {
    if (!std::filesystem::is_directory(row)) continue;
    auto files = FilesOf(row);
    auto places = Numbers(files.size());
    forth.push_back(Share(DriveOfFiles(files, places)));
    std::ranges::reverse(files);
    std::ranges::reverse(places);
    back.push_back(Share(DriveOfFiles(files, places)));
  }
  for (std::size_t i = 0; i < forth.size(); ++i) {
    for (std::size_t other = i + 1; other <= i + 2 && other < forth.size(); ++other) {
      for (const auto& query : {forth[other], back[other]}) {
        Run run = MakeRun(set, forth[i], query);
        run.tolerance = 1;
        run.tolerance_steps = 1;
        runs.push_back(std::move(run));
      }
    }
  }
}

constexpr std::array<std::pair<const char*, const char*>, 8> kChanges = {{
    {"fast", ",speed=5"},
    {"near", ",offset=2"},
    {"dark", ",light=0.6"},
    {"bright", ",light=1.5,noise=4"},
    {"return", ",travel=return,offset=1"},
    {"remove", ",remove=0.25"},
    {"wobble", ",wobble=0.3"},
    {"stop", ",stop=5"},
}};

bool Sets(const std::string& keys, const std::string& key) {
  return keys.find("," + key + "=") != std::string::npos;
}

// Two of the changes, others for each seed. Where both set the offset, the greater counts; no light
// is both dark and bright.
std::string TwoChanges(int seed) {
  std::vector<std::string> pairs;
  for (std::size_t i = 0; i < kChanges.size(); ++i) {
    for (std::size_t j = i + 1; j < kChanges.size(); ++j) {
      const bool two_lights =
          Sets(kChanges[i].second, "light") && Sets(kChanges[j].second, "light");
      pairs.push_back(std::string(kChanges[i].second) + kChanges[two_lights ? j + 1 : j].second);
    }
  }
  std::string both = pairs[static_cast<std::size_t>(seed) * 11 % pairs.size()];
  const auto offset = both.find(",offset=1");
  if (both.find(",offset=2") != std::string::npos && offset != std::string::npos) {
    both.erase(offset, std::string(",offset=1").size());
  }
  return both;
}

std::vector<std::pair<std::string, std::string>> ConditionsOf(int seed) {
  std::vector<std::pair<std::string, std::string>> conditions = {{"out", ""}, {"same", ",drive=2"}};
  for (const auto& [name, keys] : kChanges) conditions.emplace_back(name, keys);
  conditions.emplace_back("two", TwoChanges(seed));
  return conditions;
}

Run SimulatedRun(const std::string& set, const std::shared_ptr<const Drive>& map,
                 const std::shared_ptr<const Drive>& query) {
  Run run = MakeRun(set, map, query);
  run.tolerance = kSimulatedTolerance;
  run.tolerance_steps = kSimulatedToleranceSteps;
  run.after = 10;
  return run;
}

// The robot drives, is set down at least 10 m away, and drives on for 15 m.
Run Kidnapped(const std::string& set, const std::shared_ptr<const Drive>& map,
              const std::shared_ptr<const Drive>& drive, std::uint64_t seed) {
  constexpr std::size_t kBefore = 80;
  constexpr std::size_t kAfter = 70;
  Run run = SimulatedRun(set, map, drive);
  std::mt19937_64 engine(seed);
  std::uniform_int_distribution<std::size_t> from(0, drive->size() - kBefore);
  std::uniform_int_distribution<std::size_t> to(0, drive->size() - kAfter);
  const std::size_t first = from(engine);
  std::size_t second = to(engine);
  while (std::abs((*drive)[second].place - (*drive)[first + kBefore - 1].place) < 10) {
    second = to(engine);
  }
  run.query.clear();
  for (std::size_t i = 0; i < kBefore; ++i) run.query.push_back(&(*drive)[first + i]);
  for (std::size_t i = 0; i < kAfter; ++i) run.query.push_back(&(*drive)[second + i]);
  return run;
}

}  // namespace

void InParallel(std::size_t count, const std::function<void(std::size_t)>& job) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::jthread> threads;
  for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i) {
    threads.emplace_back([&] {
      for (std::size_t at = next++; at < count; at = next++) job(at);
    });
  }
}

std::vector<Run> RealRuns(const std::string& data) {
  std::vector<Run> runs;
  AddLaps(data, runs);
  AddRows(data + "/gantry", "gantry", runs);
  AddRows(data + "/shop", "shop", runs);
  return runs;
}

std::vector<Run> SimulatedRuns(int seeds, const std::string& cache) {
  struct Wanted {
    std::string name;
    std::string spec;
  };
  std::vector<Wanted> wanted;
  const std::vector<std::string> scenes = {"street", "landmarks"};
  for (const std::string& scene : scenes) {
    for (int seed = 1; seed <= seeds; ++seed) {
      for (const auto& [condition, keys] : ConditionsOf(seed)) {
        wanted.push_back({absl::StrCat(scene, " ", condition, seed),
                          absl::StrCat("sim:", scene, ",seed=", seed, ",length=60,fps=5", keys)});
      }
    }
  }
  std::vector<std::shared_ptr<const Drive>> made(wanted.size());
  InParallel(wanted.size(),
             [&](std::size_t i) { made[i] = Share(SimulatedDrive(wanted[i].spec, cache)); });
  std::map<std::string, std::shared_ptr<const Drive>> drives;
  for (std::size_t i = 0; i < wanted.size(); ++i) drives[wanted[i].name] = made[i];

  std::vector<Run> runs;
  for (const std::string& scene : scenes) {
    for (int seed = 1; seed <= seeds; ++seed) {
      const auto map = drives.at(absl::StrCat(scene, " out", seed));
      for (const auto& [condition, keys] : ConditionsOf(seed)) {
        if (condition == "out") continue;
        const std::string set = absl::StrCat(scene, " ", condition);
        runs.push_back(SimulatedRun(set, map, drives.at(absl::StrCat(set, seed))));
        if (condition == "return") runs.back().travel = Travel::kReturn;
        if (condition == "two" && keys.find("return") != std::string::npos) {
          runs.back().travel = Travel::kReturn;
        }
      }
      const auto same = drives.at(absl::StrCat(scene, " same", seed));
      for (std::uint64_t trial = 0; trial < 3; ++trial) {
        runs.push_back(Kidnapped(scene + " kidnapped", map, same,
                                 static_cast<std::uint64_t>(seed) * 100 + trial));
      }
      Run foreign = SimulatedRun(scene + " foreign", map,
                                 drives.at(absl::StrCat(scene, " same", seed % seeds + 1)));
      foreign.foreign = true;
      runs.push_back(std::move(foreign));
    }
  }
  return runs;
}

std::size_t JumpOf(const Run& run) {
  for (std::size_t i = 1; i < run.query.size(); ++i) {
    if (std::abs(run.query[i]->place - run.query[i - 1]->place) > 5) return i;
  }
  return run.query.size();
}

}  // namespace homing::accuracy
