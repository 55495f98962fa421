// One traverse of a route: what each frame gave, as flow and as a small picture, and where it was.
#ifndef TESTS_ACCURACY_DRIVE_H_
#define TESTS_ACCURACY_DRIVE_H_

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "client/simulator/simulator.h"
#include "homing/flow/observation.h"

namespace homing::accuracy {

// 64 x 32 grey values, rows from the top; empty: no camera.
using Picture = std::vector<std::uint8_t>;
inline constexpr int kPictureWidth = 64;
inline constexpr int kPictureHeight = 32;

// One frame of the source.
struct Instant {
  std::int64_t frame = 0;
  // The frame that the flow starts at.
  std::int64_t reference = 0;
  // No fields: the frame makes no step (the first one, or nothing has moved enough).
  ObservedFlow flow;
  // Of `frame`, by Side: the robot's cameras. Kept for frames that make a step.
  std::array<Picture, 2> pictures;
  // Along the outbound route, m or frames of the map, in the middle between `reference` and
  // `frame`; NaN: not known.
  double place = 0;

  bool MakesStep() const { return flow.fields[0] || flow.fields[1]; }
};

// By frame.
using Drive = std::vector<Instant>;

// Those that make a step: step k of a map recorded on the drive is number k.
std::vector<const Instant*> StepsOf(const Drive& drive);

// Mean length of a step, units of place. REQUIRES: two steps or more.
double StepLength(const Drive& drive);

struct ImageFiles {
  // Names the drive in the cache.
  std::string name;
  std::vector<std::string> files;
  // By file; NaN: not known.
  std::vector<double> places;
  // Images are brought to this size; 0 x 0: as they are.
  cv::Size size;
};

// Exits if the file cannot be read.
cv::Size ImageSizeOf(const std::string& file);

// One camera to the left. Exits if a file cannot be read. `cache`: a folder that keeps the flow, or
// empty.
Drive DriveOfFiles(const ImageFiles& images, const std::string& cache);

struct SimulatedDriveSpec {
  // "sim:..." of the command line.
  std::string spec;
  // Else the left one alone.
  bool both_cameras = true;
  // Only the last so many metres are driven; 0: all.
  double tail_m = 0;

  // Names the drive, also in the cache.
  std::string Name() const;
};

// All drives show the same frames: they differ in which of them are lost or repeated. `cache`: as
// above.
std::vector<Drive> SimulatedDrives(const std::vector<SimulatedDriveSpec>& specs,
                                   const std::string& cache);

// Ends the program with the reason.
[[noreturn]] void Fail(const std::string& reason);

}  // namespace homing::accuracy

#endif  // TESTS_ACCURACY_DRIVE_H_
