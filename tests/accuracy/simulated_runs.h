// Simulated runs.
#ifndef TESTS_ACCURACY_SIMULATED_RUNS_H_
#define TESTS_ACCURACY_SIMULATED_RUNS_H_

#include <array>
#include <cstdint>
#include <string>

#include "tests/accuracy/run_plan.h"

namespace homing::accuracy {

inline constexpr std::array<const char*, 10> kConditions = {
    "same", "fast", "near", "dark", "bright", "return", "remove", "wobble", "stop", "two"};
inline constexpr std::array<const char*, 11> kMoreConditions = {
    "varied speed", "map 30 fps",         "home 30 fps",  "repeated frames",
    "lost frames",  "lost on one camera", "steering",     "turned",
    "ahead",        "creeping map",       "creeping home"};

struct Seeds {
  int first = 1;
  int count = 0;
};

// "street" and "landmarks", routes of 60 m: sets "SCENE CONDITION" for same, fast, near, dark,
// bright, return, remove, wobble, stop, two; "SCENE foreign"; "SCENE kidnapped".
void PlanSimulatedRuns(const Seeds& seeds, const std::string& cache, RunPlan& plan);

// Instant at which a kidnapped robot is set down elsewhere: the first of run.query whose place is
// further from the one before than a robot drives.
std::size_t JumpOf(const Run& run);

}  // namespace homing::accuracy

#endif  // TESTS_ACCURACY_SIMULATED_RUNS_H_
