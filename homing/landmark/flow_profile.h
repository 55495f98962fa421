// What one camera saw at one step, cell by cell: where the flow vectors are, and how far away what
// they lie on is. The paper's count and mean (eqs 11, 12), kept for each cell of a coarse grid
// instead of once. Source: own design.
#ifndef HOMING_LANDMARK_FLOW_PROFILE_H_
#define HOMING_LANDMARK_FLOW_PROFILE_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "homing/flow/flow_vector.h"

namespace homing {

// Immutable value of 96 bytes; of one byte a cell, rows from the top, each from the left:
// - low four bits, the share code: 30 sqrt(vectors in the cell / n), rounded, at most 15; n is
//   the geometric mean of the vectors in the image and 180: half a share, which poor light leaves
//   alone, half a number, which a landmark that is gone leaves alone;
// - high four bits, the parallax code: 0 where there is no vector; else 8 + 4 log2(median flow of
//   the cell / median flow of the image), rounded, 1 to 15. The speed cancels; what is left is
//   inverse depth, which light cannot change.
struct FlowProfile {
  static constexpr int kColumns = 12;
  static constexpr int kRows = 8;
  static constexpr int kCells = kColumns * kRows;
  static constexpr int kMaxCode = 15;
  static constexpr double kSharePerRoot = 30;
  static constexpr double kUsualCount = 180;
  static constexpr int kMedianParallax = 8;
  static constexpr int kParallaxPerOctave = 4;

  std::array<std::uint8_t, kCells> cells{};

  int share(int cell) const { return cells[static_cast<std::size_t>(cell)] & kMaxCode; }
  int parallax(int cell) const { return cells[static_cast<std::size_t>(cell)] >> 4; }
  friend bool operator==(const FlowProfile&, const FlowProfile&) = default;
};

// Makes profiles of one rectified field. Immutable.
class ProfileMaker {
 public:
  // Non-finite vectors are left out.
  explicit ProfileMaker(const FlowField& field);

  // Of the vectors, by their midpoints; those outside the image are left out. All cells 0 if none
  // is left. `magnification` > 0: as the same camera would see it from so much nearer that what has
  // the median flow looks so much larger (about the middle of the image); what is nearer than that
  // changes more, what is further away less. One that fills only a part of the image has that part
  // of the vectors.
  FlowProfile Make(double magnification = 1) const;
  // Vectors.
  std::size_t size() const { return midpoints_.lengths.size(); }

 private:
  // Midpoints from the middle of the image, in images; lengths in pixels.
  struct Midpoints {
    explicit Midpoints(std::size_t size = 0) : x(size), y(size), lengths(size) {}
    std::vector<double> x;
    std::vector<double> y;
    std::vector<double> lengths;
  };

  static void FillMidpoints(const FlowField& field, double* __restrict x, double* __restrict y,
                            double* __restrict lengths);
  // Where each midpoint lies in the magnified image, and how long its vector is there.
  static void Magnify(const Midpoints& midpoints, double magnification, double per_median,
                      std::int32_t* __restrict cells, double* __restrict lengths);

  // The shortest vector first.
  Midpoints midpoints_;
};

inline FlowProfile MakeFlowProfile(const FlowField& field) { return ProfileMaker(field).Make(); }

}  // namespace homing

#endif  // HOMING_LANDMARK_FLOW_PROFILE_H_
