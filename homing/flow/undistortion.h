// Lens models and their inverses. k1, k2, p1, p2, k3: Brown, "Decentering distortion of lenses",
// 1966; k4, k5, k6: a divisor of the radial part, as OpenCV has it. Fisheye: Kannala and Brandt, "A
// generic camera model", 2006. Inverses by Newton's method.
#ifndef HOMING_FLOW_UNDISTORTION_H_
#define HOMING_FLOW_UNDISTORTION_H_

#include <Eigen/Core>
#include <array>
#include <optional>

namespace homing {

// k1, k2, p1, p2, k3, k4, k5, k6; for a fisheye lens k1, k2, k3, k4 and zeros.
using Distortion = std::array<double, 8>;

// The point at which the lens shows the ray (x, y, 1), in focal lengths from the principal point.
Eigen::Vector2d Distort(const Eigen::Vector2d& ray, const Distortion& distortion);

// The ray that the lens shows at this point; nothing where the model has no inverse.
std::optional<Eigen::Vector2d> Undistort(const Eigen::Vector2d& shown,
                                         const Distortion& distortion);

// The same of a fisheye lens, which shows a ray at the angle a from its axis at the distance
// a (1 + k1 a^2 + k2 a^4 + k3 a^6 + k4 a^8) from the centre. Nothing for rays from the side or
// behind.
Eigen::Vector2d DistortFisheye(const Eigen::Vector2d& ray, const Distortion& distortion);
std::optional<Eigen::Vector2d> UndistortFisheye(const Eigen::Vector2d& shown,
                                                const Distortion& distortion);

}  // namespace homing

#endif  // HOMING_FLOW_UNDISTORTION_H_
