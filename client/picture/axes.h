// The frame of a plot: scales, ticks, labels, legend.
#ifndef CLIENT_PICTURE_AXES_H_
#define CLIENT_PICTURE_AXES_H_

#include <string>
#include <vector>

#include "client/picture/canvas.h"

namespace homing::client {

struct Range {
  double low = 0;
  double high = 1;
};

struct AxisText {
  std::string title;
  std::string x;
  std::string y;
};

// About `count` round values at a round distance inside `range`, which may be descending.
std::vector<double> RoundTicks(const Range& range, int count);

struct LegendEntry {
  std::string text;
  Colour colour;
  // A line instead of a dot.
  bool line = true;
};

// Position of a legend: in a corner of the box, or in one line above it.
enum class LegendPlace { kUpperRight, kLowerRight, kAbove };

// Not thread-safe; `canvas` must outlive it.
class Axes {
 public:
  Axes(Canvas* canvas, const Box& box, const Range& x, const Range& y);

  // Draws grid, frame, ticks and labels. Call it first.
  void Draw(const AxisText& text);
  void Legend(const std::vector<LegendEntry>& entries,
              LegendPlace place = LegendPlace::kUpperRight);

  double X(double value) const;
  double Y(double value) const;
  Point At(double x, double y) const { return {X(x), Y(y)}; }
  const Box& box() const { return box_; }

 private:
  // Its mark and text, from the left end of its base line.
  void DrawEntry(const LegendEntry& entry, Point at);

  Canvas* canvas_;
  Box box_;
  Range x_;
  Range y_;
};

}  // namespace homing::client

#endif  // CLIENT_PICTURE_AXES_H_
