// The line that the outbound robot follows.
#ifndef CLIENT_SIMULATOR_ROUTE_H_
#define CLIENT_SIMULATOR_ROUTE_H_

#include <array>
#include <vector>

#include "client/simulator/geometry.h"

namespace homing::client {

// A straight line, or one that bends gently to either side in turn: heading = bend sin(2 pi s /
// period + phase). It may also have two corners.
struct RouteBend {
  double bend_rad = 0;
  double period_m = 100;
  double phase_rad = 0;
  // Angle by which the first corner turns the line to the left and the second one back, rad. Each
  // corner is kCornerM long.
  double corner_rad = 0;
  std::array<double, 2> corners_m{};

  static constexpr double kCornerM = 8;
};

// Immutable.
class Route {
 public:
  Route(double length_m, const RouteBend& bend);

  // The line's point and direction `route_m` from home; also a little beyond both ends.
  Pose At(double route_m) const;
  double length_m() const { return length_m_; }
  // The place of the nearest point along the line and its margins, m.
  double Nearest(const Vector2& point) const;

  // The line is known this far beyond its ends.
  static constexpr double kMarginM = 100;

 private:
  double Heading(double route_m) const;
  Vector2 Advanced(const Vector2& from, double route_m, double step_m) const;

  double length_m_;
  RouteBend bend_;
  // Points of the line, one a metre, from -kMarginM on.
  std::vector<Vector2> nodes_;
};

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_ROUTE_H_
