#include "homing/flow/motion.h"

#include <cmath>
#include <vector>

#include "homing/flow/rotation_fit.h"

namespace homing {
namespace {

// Median length below which nothing moves, over the image width: half a pixel at 370, over three
// times what noise of 4 of 255 makes of a standing camera's flow.
constexpr double kStandingShare = 1.35e-3;
// A camera with fewer vectors has no say, but that a few that move are enough against standing.
constexpr std::size_t kMinVectors = 8;
constexpr std::size_t kFewVectors = 3;
// Fewer than this in all may lie on what is too far away to be seen moving.
constexpr std::size_t kMinStandingVectors = 40;
// What a turn on the spot must explain.
constexpr double kMinExplained = 0.8;
constexpr double kMaxResidualRatio = 0.25;
// The two cameras' pans, and one camera's pan and vertical pan, agree within this factor.
constexpr double kMaxPanRatio = 2;
// Standard errors that tell a vertical pan from none.
constexpr double kMinSignificance = 4;

bool IsExplained(const RotationFit& fit) {
  return fit.explained >= kMinExplained &&
         fit.median_residual <= kMaxResidualRatio * fit.median_length;
}

// Same sign, and alike in size.
bool Agree(double a, double b) {
  return a * b > 0 && std::abs(a) <= kMaxPanRatio * std::abs(b) &&
         std::abs(b) <= kMaxPanRatio * std::abs(a);
}

// One camera cannot compare: a flat wall passed sideways moves much as if the camera turned, but
// for the vertical components.
bool IsTurning(const RotationFit& fit) {
  return IsExplained(fit) && Agree(fit.pan, fit.vertical_pan) &&
         std::abs(fit.vertical_pan) >= kMinSignificance * fit.vertical_pan_error;
}

// A turn moves the images of both sideways cameras the same way, driving moves them opposite ways.
bool IsTurning(const RotationFit& left, const RotationFit& right) {
  return IsExplained(left) && IsExplained(right) && Agree(left.pan, right.pan);
}

}  // namespace

Motion ClassifyMotion(const ObservedFlow& flow, const std::array<Camera, 2>& cameras) {
  std::vector<RotationFit> fits;
  bool standing = true;
  std::size_t vectors = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    const auto& field = flow.fields[side];
    if (!field.has_value() || field->vectors.size() < kFewVectors) {
      continue;
    }
    const RotationFit fit = FitRotation(*field, cameras[side]);
    standing = standing && fit.median_length < kStandingShare * field->width;
    vectors += field->vectors.size();
    if (field->vectors.size() >= kMinVectors) {
      fits.push_back(fit);
    }
  }
  if (fits.empty()) {
    return Motion::kMoving;
  }
  if (standing && vectors >= kMinStandingVectors) {
    return Motion::kStanding;
  }
  const bool turning = fits.size() == 2 ? IsTurning(fits[0], fits[1]) : IsTurning(fits[0]);
  return turning ? Motion::kTurning : Motion::kMoving;
}

}  // namespace homing
