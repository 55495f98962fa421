// The two worlds: landmarks as in the paper (III, Figs 3 to 7), and a street. Both draw from one
// texture pool. Another seed gives another route of the same kind.
#ifndef CLIENT_SIMULATOR_WORLDS_H_
#define CLIENT_SIMULATOR_WORLDS_H_

#include <cstdint>

#include "client/simulator/route.h"
#include "client/simulator/scene.h"
#include "client/simulator/simulator.h"

namespace homing::client {

// A route's bend, by seed: up to 0.08 rad to either side.
RouteBend BendOf(std::uint64_t seed);

// REQUIRES: Validate(spec).ok().
Route MakeRoute(const SimulationSpec& spec);
Scene MakeScene(const SimulationSpec& spec, const Route& route);

// Makes spheres, towers, parallelograms and hills 3 to 15 m to either side, with gaps. `remove` is
// the fraction of landmarks left out, [0, 1]; a larger value leaves out the same ones and more.
Scene MakeLandmarkScene(const Route& route, std::uint64_t seed, double remove);

// Makes rows of repeating facades with gaps, and posts and parked boxes before them.
Scene MakeStreetScene(const Route& route, std::uint64_t seed, double remove);

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_WORLDS_H_
