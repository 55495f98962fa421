// The runs: real development sequences, and simulated drives under every condition.
#ifndef TESTS_ACCURACY_SEQUENCES_H_
#define TESTS_ACCURACY_SEQUENCES_H_

#include <functional>
#include <string>
#include <vector>

#include "tests/accuracy/run.h"

namespace homing::accuracy {

// Calls job(0) .. job(count - 1) on all cores.
void InParallel(std::size_t count, const std::function<void(std::size_t)>& job);

// `data`: the folder of real sequences. Sets "laps", "laps dim", "gantry", "shop".
std::vector<Run> RealRuns(const std::string& data);

inline constexpr double kSimulatedTolerance = 1;
// 1 m at 4 km/h and 5 frames a second.
inline constexpr int kSimulatedToleranceSteps = 4;

// Seeds 1 to `seeds` of "street" and "landmarks", routes of 60 m: sets "SCENE CONDITION" for same,
// fast, near, dark, bright, return, remove, wobble, stop, two; "SCENE foreign"; "SCENE kidnapped".
std::vector<Run> SimulatedRuns(int seeds, const std::string& cache);

// Instant at which a kidnapped robot is set down elsewhere: the first of run.query whose place is
// further from the one before than a robot drives.
std::size_t JumpOf(const Run& run);

}  // namespace homing::accuracy

#endif  // TESTS_ACCURACY_SEQUENCES_H_
