// A fleet's store: many long journeys, and robots that come home without naming theirs.
#ifndef TESTS_ACCURACY_FLEET_H_
#define TESTS_ACCURACY_FLEET_H_

#include "client/connection.h"

namespace homing::accuracy {

struct FleetOptions {
  // Each robot has recorded one, and comes home along it.
  int journeys = 100;
  double length_m = 500;
  // Told where it is after this way home; within this of the truth. Metres.
  double driven_m = 15;
  double tolerance_m = 1;
};

struct FleetResult {
  int robots = 0;
  // Right journey, and step within the tolerance.
  int right = 0;
  // Of these, with a probability of MATCH.
  int sure = 0;

  double share() const { return robots == 0 ? 0 : static_cast<double>(right) / robots; }
};

// Records all journeys, then each robot drives home from anywhere on its own, 25 % faster and half
// a metre aside, and asks all journeys at once.
FleetResult RunFleet(const client::Connection& server, const FleetOptions& options);

}  // namespace homing::accuracy

#endif  // TESTS_ACCURACY_FLEET_H_
