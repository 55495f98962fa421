// Runs of real development sequences.
#ifndef TESTS_ACCURACY_REAL_RUNS_H_
#define TESTS_ACCURACY_REAL_RUNS_H_

#include <string>

#include "tests/accuracy/run_plan.h"

namespace homing::accuracy {

// `data`: the folder of real sequences. Sets: "laps", "laps dim", "gantry", "shop" and "NAME",
// "NAME:2", ... of each other folder that holds a map; "foreign NAME" (another route of the same
// camera) and "foreign NAME OTHER" (the query of another set, brought to the map's size).
void PlanRealRuns(const std::string& data, const std::string& cache, RunPlan& plan);

}  // namespace homing::accuracy

#endif  // TESTS_ACCURACY_REAL_RUNS_H_
