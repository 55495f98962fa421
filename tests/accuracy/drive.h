// One traverse of a route: what the cameras gave, as flow and as small pictures, and where it was.
#ifndef TESTS_ACCURACY_DRIVE_H_
#define TESTS_ACCURACY_DRIVE_H_

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "client/simulator/simulator.h"
#include "homing/flow/observation.h"

namespace homing::accuracy {

// 64 x 32 grey values, rows from the top; empty: no camera.
using Picture = std::vector<std::uint8_t>;
inline constexpr int kPictureWidth = 64;
inline constexpr int kPictureHeight = 32;

// Between two frames.
struct Instant {
  ObservedFlow flow;
  // Of the later frame, by Side: the robot's cameras.
  std::array<Picture, 2> pictures;
  // Along the outbound route, m or frames; NaN: not known.
  double place = 0;
};

using Drive = std::vector<Instant>;

// One camera to the left; file k is at place `places[k]`. Exits if a file cannot be read.
Drive DriveOfFiles(const std::vector<std::string>& files, const std::vector<double>& places);

// "sim:..." of the command line. Kept in `cache` (a folder, or empty: not kept).
Drive SimulatedDrive(const std::string& spec, const std::string& cache);

// Ends the program with the reason.
[[noreturn]] void Fail(const std::string& reason);

}  // namespace homing::accuracy

#endif  // TESTS_ACCURACY_DRIVE_H_
