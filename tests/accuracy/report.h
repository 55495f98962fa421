// docs/results.md, and a line for each bound.
#ifndef TESTS_ACCURACY_REPORT_H_
#define TESTS_ACCURACY_REPORT_H_

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/accuracy/fleet.h"
#include "tests/accuracy/run.h"

namespace homing::accuracy {

struct Bound {
  std::string name;
  double value = 0;
  double bound = 0;
  // Else at most.
  bool at_least = true;

  bool Holds() const { return at_least ? value >= bound : value <= bound; }
};

struct Measurements {
  std::vector<Run> runs;
  // What keeps pictures was run too.
  bool has_peers = false;
  // By real set, then one for the simulated ones.
  std::vector<std::pair<std::string, double>> microseconds;
  std::vector<std::pair<std::string, double>> bytes;
  // Steps of a journey, microseconds a camera and observation on it.
  std::vector<std::pair<std::int64_t, double>> long_journeys;
  FleetResult fleet;
};

struct Report {
  std::string markdown;
  std::vector<Bound> bounds;
};

Report MakeReport(const Measurements& measurements);

}  // namespace homing::accuracy

#endif  // TESTS_ACCURACY_REPORT_H_
