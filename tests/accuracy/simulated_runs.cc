#include "tests/accuracy/simulated_runs.h"

#include <array>
#include <random>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"

namespace homing::accuracy {
namespace {

constexpr double kToleranceM = 1;

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
  run.after = 10;
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

class Planner {
 public:
  Planner(const Seeds& seeds, const std::string& cache, RunPlan& plan)
      : seeds_(seeds), cache_(cache), plan_(plan) {}

  void Plan() {
    for (const std::string scene : {"street", "landmarks"}) {
      for (int i = 0; i < seeds_.count; ++i) World(scene, seeds_.first + i);
      for (int i = 0; i < seeds_.count; ++i) Lost(scene, i);
    }
  }

 private:
  static std::string Spec(const std::string& scene, int seed, const std::string& keys) {
    return absl::StrCat("sim:", scene, ",seed=", seed, ",length=60,fps=5", keys);
  }

  // The drive's name is its spec.
  std::string Add(const std::string& spec) {
    plan_.AddDrives({spec}, [spec, cache = cache_] { return SimulatedDrives({spec}, cache); });
    return spec;
  }

  void World(const std::string& scene, int seed) {
    const std::string map = Add(Spec(scene, seed, ""));
    for (const auto& [condition, keys] : ConditionsOf(seed)) {
      Run run = SimulatedRun(scene + " " + condition);
      if (keys.find("return") != std::string::npos) run.travel = Travel::kReturn;
      plan_.AddRun(std::move(run), map, Add(Spec(scene, seed, keys)));
    }
  }

  void Lost(const std::string& scene, int index) {
    const int seed = seeds_.first + index;
    const int other = seeds_.first + (index + 1) % seeds_.count;
    const std::string map = Spec(scene, seed, "");
    for (std::uint64_t trial = 0; trial < 3; ++trial) {
      plan_.AddRun(
          SimulatedRun(scene + " kidnapped"), map, Spec(scene, seed, kSame),
          [seed, trial](Run& run) { Kidnap(static_cast<std::uint64_t>(seed) * 100 + trial, run); });
    }
    Run foreign = SimulatedRun(scene + " foreign");
    foreign.foreign = true;
    plan_.AddRun(std::move(foreign), map, Spec(scene, other, kSame));
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
