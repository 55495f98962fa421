// The view of one camera at one step: where the flow vectors are, how near their objects are, and
// how far the camera moved. It keeps the paper's count and mean (eqs 11, 12) for each cell of a
// coarse grid.
#ifndef HOMING_LANDMARK_FLOW_PROFILE_H_
#define HOMING_LANDMARK_FLOW_PROFILE_H_

#include <array>
#include <cstdint>
#include <vector>

#include "homing/flow/flow_vector.h"
#include "homing/landmark/odometer_reading.h"

namespace homing {

// Immutable value. One byte a cell, rows from the top, each row from the left:
// - low four bits, the count code: 30 sqrt(vectors in the cell / n), rounded, at most 15. n is the
//   geometric mean of the vectors in the image and 180. So the code depends half on the fraction
//   of the vectors, which poor light does not change, and half on their number, which a removed
//   landmark does not change.
// - high four bits, the parallax code: 0 where there are no vectors; else 8 + 4 times the mean
//   log2(flow / mean flow of the image), rounded, 1 to 15. The speed cancels. What remains is
//   inverse depth, which does not depend on light. Two neighbouring columns share one code.
// Each vector counts in the four cells around its midpoint, by bilinear weights: a vector near a
// border changes the profile little when it crosses the border.
struct FlowProfile {
  static constexpr int kColumns = 16;
  static constexpr int kRows = 10;
  static constexpr int kCells = kColumns * kRows;
  static constexpr int kMaxCode = 15;
  static constexpr double kCountPerRoot = 30;
  static constexpr double kUsualCount = 180;
  static constexpr int kMeanParallax = 8;
  static constexpr int kParallaxPerOctave = 4;

  std::array<std::uint8_t, kCells> cells{};
  OdometerReading odometer;

  int count_code(int cell) const { return cells[static_cast<std::size_t>(cell)] & kMaxCode; }
  int parallax_code(int cell) const { return cells[static_cast<std::size_t>(cell)] >> 4; }
  friend bool operator==(const FlowProfile&, const FlowProfile&) = default;
};

// Makes profiles of one rectified field. Immutable; thread-safe.
class ProfileMaker {
 public:
  // Leaves out vectors that are not finite.
  explicit ProfileMaker(const FlowField& field);
  // The same for a field whose odometer reading is known.
  ProfileMaker(const FlowField& field, const OdometerReading& odometer);

  // The profile of the vectors whose midpoints lie in the image; all zero if there are none.
  // `magnification` > 0: the view of the same camera from so much nearer that objects with the mean
  // flow look larger by this factor (about the middle of the image). Nearer objects change more,
  // farther ones less. A magnification below 1 fills only a part of the image with that part of
  // the vectors. `shift`: then moves the image to the right by so many image widths, as a turn of
  // the camera to the left does. The odometer reading is that of the unchanged image.
  FlowProfile Make(double magnification = 1, double shift = 0) const;
  // Number of vectors.
  std::size_t size() const { return x_.size(); }
  const OdometerReading& odometer() const { return odometer_; }

 private:
  // Midpoints from the middle of the image, in image sizes; log2 of the flow, pixels.
  std::vector<float> x_;
  std::vector<float> y_;
  std::vector<float> log_flow_;
  // Mean of log_flow_.
  float mean_log_flow_ = 0;
  OdometerReading odometer_;
};

inline FlowProfile MakeFlowProfile(const FlowField& field) { return ProfileMaker(field).Make(); }

}  // namespace homing

#endif  // HOMING_LANDMARK_FLOW_PROFILE_H_
