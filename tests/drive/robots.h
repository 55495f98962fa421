// Robots that drive home under one condition, and how they fared.
#ifndef TESTS_DRIVE_ROBOTS_H_
#define TESTS_DRIVE_ROBOTS_H_

#include <string>
#include <vector>

#include "client/drive/home_drive.h"

namespace homing::drive {

struct Condition {
  std::string name = {};
  // Of the world on the way home, and of the route: keys of the simulator.
  std::string home_keys = {};
  std::string route_keys = {};
  double light = 1;
  double home_fps = 10;
  double delay_s = 0.1;
  double lost = 0;
  double outage_s = 0;
  double carried_m = 0;
  bool blindfolded = false;
  // Rendered images and tracked flow, not projected corners.
  bool rendered = false;
  // Share of the robots that come home: at least, and at most.
  double least_home = 0;
  double most_home = 1;
  // Robots that are driven even where fewer are asked for.
  int least_robots = 0;
  // Also the bounds of the cross-track error.
  bool bounds_error = false;
};

struct Fared {
  bool came_home = false;
  double end_m = 0;
  // On the way, m beside the outbound path.
  std::vector<double> beside_m;
  double most_beside_m = 0;
  client::HomeDrive drive = {};
};

// Robot number `index` of a condition: street and landmarks, RETURN and SAME in turn, in world
// `world`. Exits where the machinery fails.
Fared DriveOne(const Condition& condition, int index, int world);

}  // namespace homing::drive

#endif  // TESTS_DRIVE_ROBOTS_H_
