// A flow vector: one corner tracked from the reference frame to a later one (paper II-B).
#ifndef HOMING_FLOW_FLOW_VECTOR_H_
#define HOMING_FLOW_FLOW_VECTOR_H_

#include <cmath>
#include <vector>

namespace homing {

// Pixels of the source image, origin top left, x right, y down.
struct FlowVector {
  float start_x = 0;
  float start_y = 0;
  float end_x = 0;
  float end_y = 0;

  // The mean of its two ends (III).
  double MidX() const { return 0.5 * (double{start_x} + double{end_x}); }
  double MidY() const { return 0.5 * (double{start_y} + double{end_y}); }
  double FlowX() const { return double{end_x} - double{start_x}; }
  double FlowY() const { return double{end_y} - double{start_y}; }
  double Length() const { return std::sqrt(FlowX() * FlowX() + FlowY() * FlowY()); }
  friend bool operator==(const FlowVector&, const FlowVector&) = default;
};

// All vectors from the reference frame of one camera to a later frame.
struct FlowField {
  // Size of the images, pixels.
  int width = 0;
  int height = 0;
  std::vector<FlowVector> vectors;
};

}  // namespace homing

#endif  // HOMING_FLOW_FLOW_VECTOR_H_
