#include "client/simulator/route.h"

#include <algorithm>
#include <cstddef>
#include <numbers>

namespace homing::client {

Route::Route(double length_m, const RouteBend& bend) : length_m_(length_m), bend_(bend) {
  const auto count = static_cast<std::size_t>(length_m + 2 * kMarginM) + 2;
  nodes_.reserve(count);
  nodes_.emplace_back(-kMarginM, 0);
  for (std::size_t i = 1; i < count; ++i) {
    nodes_.push_back(Advanced(nodes_.back(), static_cast<double>(i - 1) - kMarginM, 1));
  }
}

double Route::Heading(double route_m) const {
  double heading =
      bend_.bend_rad * std::sin(2 * std::numbers::pi * route_m / bend_.period_m + bend_.phase_rad);
  double corner = bend_.corner_rad;
  for (const double middle_m : bend_.corners_m) {
    heading += corner * std::clamp((route_m - middle_m) / RouteBend::kCornerM + 0.5, 0.0, 1.0);
    corner = -corner;
  }
  return heading;
}

// Simpson's rule.
Vector2 Route::Advanced(const Vector2& from, double route_m, double step_m) const {
  const auto direction = [&](double share) {
    const double heading = Heading(route_m + share * step_m);
    return Vector2(std::cos(heading), std::sin(heading));
  };
  return from + step_m / 6 * (direction(0) + 4 * direction(0.5) + direction(1));
}

Pose Route::At(double route_m) const {
  const double bounded = std::clamp(route_m, -kMarginM, length_m_ + kMarginM);
  const auto node = static_cast<std::size_t>(bounded + kMarginM);
  const double start = static_cast<double>(node) - kMarginM;
  return {Advanced(nodes_[node], start, bounded - start), Heading(bounded)};
}

double Route::Nearest(const Vector2& point) const {
  const auto nearest = std::ranges::min_element(nodes_, {}, [&point](const Vector2& node) {
    const Vector2 away = point - node;
    return away.dot(away);
  });
  double route_m = static_cast<double>(nearest - nodes_.begin()) - kMarginM;
  // Moves along the line by the remaining distance, four times; the line is nearly straight.
  for (int i = 0; i < 4; ++i) {
    const Pose at = At(route_m);
    route_m += (point - at.position).dot(at.Along());
  }
  return std::clamp(route_m, -kMarginM, length_m_ + kMarginM);
}

}  // namespace homing::client
