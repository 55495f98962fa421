#include "tests/accuracy/simulated_runs.h"

#include <array>
#include <random>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"

namespace homing::accuracy {
namespace {

constexpr double kToleranceM = 1;
constexpr double kJudgedAfterM = 10;

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

constexpr char kSame[] = ",drive=2";

std::vector<std::pair<std::string, std::string>> ConditionsOf(int seed) {
  std::vector<std::pair<std::string, std::string>> conditions = {{"same", kSame}};
  for (const auto& [name, keys] : kChanges) conditions.emplace_back(name, keys);
  conditions.emplace_back("two", TwoChanges(seed));
  return conditions;
}

Run SimulatedRun(const std::string& set) {
  Run run;
  run.set = set;
  run.tolerance = kToleranceM;
  run.tolerance_steps = 0;
  run.after = kJudgedAfterM;
  return run;
}

// The robot drives, is set down at least 10 m away, and drives on for 15 m.
void Kidnap(std::uint64_t seed, Run& run) {
  constexpr std::size_t kBefore = 80;
  constexpr std::size_t kAfter = 70;
  const Drive& drive = *run.query_drive;
  std::mt19937_64 engine(seed);
  std::uniform_int_distribution<std::size_t> from(1, drive.size() - kBefore);
  std::uniform_int_distribution<std::size_t> to(1, drive.size() - kAfter);
  const std::size_t first = from(engine);
  std::size_t second = to(engine);
  while (std::abs(drive[second].place - drive[first + kBefore - 1].place) < 10) {
    second = to(engine);
  }
  run.query.clear();
  for (std::size_t i = 0; i < kBefore; ++i) run.query.push_back(&drive[first + i]);
  for (std::size_t i = 0; i < kAfter; ++i) run.query.push_back(&drive[second + i]);
}

std::string Spec(const std::string& scene, int seed, const std::string& keys, int length_m = 60,
                 int fps = 5) {
  return absl::StrCat("sim:", scene, ",seed=", seed, ",length=", length_m, ",fps=", fps, keys);
}

class Planner {
 public:
  Planner(const Seeds& seeds, const std::string& cache, RunPlan& plan)
      : seeds_(seeds), cache_(cache), plan_(plan) {}

  void Plan() {
    for (const std::string scene : {"street", "landmarks"}) {
      for (int i = 0; i < seeds_.count; ++i) {
        World(scene, seeds_.first + i);
        Cameras(scene, seeds_.first + i);
        PastTheEnds(scene, seeds_.first + i);
        if (4 * i < seeds_.count) Creeping(scene, seeds_.first + i);
      }
      for (int i = 0; i < seeds_.count; ++i) Lost(scene, i);
    }
  }

 private:
  std::string Add(const SimulatedDriveSpec& spec) {
    plan_.AddDrives({spec.Name()},
                    [spec, cache = cache_] { return SimulatedDrives({spec}, cache); });
    return spec.Name();
  }
  std::string Add(const std::string& spec) { return Add(SimulatedDriveSpec{spec}); }

  void AddRun(const std::string& set, const std::string& map, const std::string& query,
              double after = kJudgedAfterM) {
    Run run = SimulatedRun(set);
    run.after = after;
    if (query.find("travel=return") != std::string::npos) run.travel = Travel::kReturn;
    plan_.AddRun(std::move(run), map, query);
  }

  void World(const std::string& scene, int seed) {
    const std::string map = Add(Spec(scene, seed, ""));
    for (const auto& [condition, keys] : ConditionsOf(seed)) {
      AddRun(scene + " " + condition, map, Add(Spec(scene, seed, keys)));
    }
    AddRun(scene + " varied speed", map, Add(Spec(scene, seed, ",vary=1")));
    AddRun(scene + " steering", map, Add(Spec(scene, seed, ",yaw_wobble=5")));
    // The same frames as on the drive "same".
    const std::vector<std::pair<std::string, std::string>> arrivals = {
        {"same", ""},
        {"repeated frames", ",repeat=5"},
        {"lost frames", ",drop=0.3"},
        {"lost on one camera", ",drop_run=10"}};
    std::vector<SimulatedDriveSpec> specs;
    std::vector<std::string> names;
    for (const auto& [condition, keys] : arrivals) {
      specs.push_back({Spec(scene, seed, kSame + keys)});
      names.push_back(specs.back().Name());
      if (condition != "same") AddRun(scene + " " + condition, map, names.back());
    }
    plan_.AddDrives(names, [specs, cache = cache_] { return SimulatedDrives(specs, cache); });
  }

  // Other frame rates, and cameras that look elsewhere.
  void Cameras(const std::string& scene, int seed) {
    const std::string quick = Add(Spec(scene, seed, ",drive=3", 30, 30));
    AddRun(scene + " map 30 fps", quick, Add(Spec(scene, seed, kSame, 30)));
    AddRun(scene + " home 30 fps", SimulatedDriveSpec{Spec(scene, seed, "")}.Name(), quick);
    AddRun(scene + " turned", Add(Spec(scene, seed, ",yaw=30")),
           Add(Spec(scene, seed, ",yaw=30,travel=return")));
    AddRun(scene + " ahead", Add(SimulatedDriveSpec{Spec(scene, seed, ",yaw=90"), false}),
           Add(SimulatedDriveSpec{Spec(scene, seed, ",yaw=90,drive=2"), false}));
  }

  // The robot begins 25 m before the end and drives on for 40 m.
  void PastTheEnds(const std::string& scene, int seed) {
    const std::string map = SimulatedDriveSpec{Spec(scene, seed, "")}.Name();
    for (const bool home : {false, true}) {
      Run run = SimulatedRun(scene + (home ? " past home" : " past the far end"));
      run.end = home ? 0 : 60;
      if (home) run.travel = Travel::kReturn;
      plan_.AddRun(std::move(run), map,
                   Add(SimulatedDriveSpec{
                       Spec(scene, seed, home ? ",extra=40,travel=return" : ",extra=40,drive=4"),
                       true, 65}));
    }
  }

  void Creeping(const std::string& scene, int seed) {
    constexpr double kAfterM = 2;
    const std::string usual = Add(Spec(scene, seed, "", 6));
    const std::string creeping = Add(Spec(scene, seed, ",speed=0.8", 6, 60));
    AddRun(scene + " creeping map", creeping, Add(Spec(scene, seed, kSame, 6)), kAfterM);
    AddRun(scene + " creeping home", usual, creeping, kAfterM);
  }

  void Lost(const std::string& scene, int index) {
    const int seed = seeds_.first + index;
    const int other = seeds_.first + (seeds_.count > 1 ? (index + 1) % seeds_.count : 1);
    if (seeds_.count == 1) Add(Spec(scene, other, kSame));
    const std::string map = SimulatedDriveSpec{Spec(scene, seed, "")}.Name();
    for (std::uint64_t trial = 0; trial < 3; ++trial) {
      plan_.AddRun(SimulatedRun(scene + " kidnapped"), map,
                   SimulatedDriveSpec{Spec(scene, seed, kSame)}.Name(), [seed, trial](Run& run) {
                     Kidnap(static_cast<std::uint64_t>(seed) * 100 + trial, run);
                   });
    }
    Run foreign = SimulatedRun(scene + " foreign");
    foreign.foreign = true;
    plan_.AddRun(std::move(foreign), map, SimulatedDriveSpec{Spec(scene, other, kSame)}.Name());
  }

  Seeds seeds_;
  std::string cache_;
  RunPlan& plan_;
};

}  // namespace

void PlanSimulatedRuns(const Seeds& seeds, const std::string& cache, RunPlan& plan) {
  Planner(seeds, cache, plan).Plan();
}

std::size_t JumpOf(const Run& run) {
  for (std::size_t i = 1; i < run.query.size(); ++i) {
    if (std::abs(run.query[i]->place - run.query[i - 1]->place) > 5) return i;
  }
  return run.query.size();
}

}  // namespace homing::accuracy
