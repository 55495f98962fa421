// Homing itself on a run: through a server, or by the library alone (the same answers, faster).
#ifndef TESTS_ACCURACY_HOMING_RUNS_H_
#define TESTS_ACCURACY_HOMING_RUNS_H_

#include <cstdint>
#include <string>

#include "client/connection.h"
#include "homing/journey/journey_map.h"
#include "tests/accuracy/run.h"

namespace homing::accuracy {

// What Homing records on the drive.
JourneyMap MapOf(const Drive& drive);

// Fills run.homing and run.single_frame (best P_T alone). `server` null: without a server.
// `number` makes the journeys' names unique.
void LocalizeRun(const client::Connection* server, int number, Run& run);

// Median microseconds for one camera of Localizer::Localize on a journey of `steps` steps, by a
// robot that comes home along it; all matches reported.
double MicrosecondsAtSteps(std::int64_t steps);

// Median microseconds that one Localizer::Localize takes on the run's maps, without a server.
double MicrosecondsAnObservation(const Run& run);

// Bytes that a step of one camera takes in the exported map of the run's first drive.
double BytesACameraStep(const Run& run);

}  // namespace homing::accuracy

#endif  // TESTS_ACCURACY_HOMING_RUNS_H_
