// The lens model k1, k2, p1, p2, k3 and its inverse. Source: Brown, "Decentering distortion of
// lenses", 1966; inverse by Newton's method, own design.
#ifndef HOMING_FLOW_UNDISTORTION_H_
#define HOMING_FLOW_UNDISTORTION_H_

#include <Eigen/Core>
#include <array>
#include <optional>

namespace homing {

// k1, k2, p1, p2, k3.
using Distortion = std::array<double, 5>;

// Where the lens shows the ray (x, y, 1). Units of the focal length from the principal point.
Eigen::Vector2d Distort(const Eigen::Vector2d& ray, const Distortion& distortion);

// The ray that the lens shows at this point; nothing where the model has no inverse.
std::optional<Eigen::Vector2d> Undistort(const Eigen::Vector2d& shown,
                                         const Distortion& distortion);

}  // namespace homing

#endif  // HOMING_FLOW_UNDISTORTION_H_
