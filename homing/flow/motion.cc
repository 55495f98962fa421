#include "homing/flow/motion.h"

#include <cmath>
#include <vector>

#include "homing/flow/rotation_fit.h"

namespace homing {
namespace {

// A rotation explains at least this fraction of the flow of a turn on the spot.
constexpr double kMinExplained = 0.8;
constexpr double kMaxResidualRatio = 0.25;
// One camera's pan and vertical pan agree within this factor.
constexpr double kMaxPanRatio = 2;
// The two cameras' pans agree within this factor: a robot that turns while it drives past distant
// objects moves both images the same way, too.
constexpr double kMaxRatioOfBoth = 1.3;
// A vertical pan is significant from this many standard errors on.
constexpr double kMinSignificance = 4;

bool IsExplained(const RotationFit& fit) {
  return fit.explained >= kMinExplained &&
         fit.median_residual <= kMaxResidualRatio * fit.median_length;
}

// Same sign, and alike in size, within the factor `most`.
bool Agree(double a, double b, double most) {
  return a * b > 0 && std::abs(a) <= most * std::abs(b) && std::abs(b) <= most * std::abs(a);
}

// A single camera needs the vertical components: without them a flat wall passed sideways moves
// nearly as if the camera turned.
bool IsTurning(const RotationFit& fit) {
  return IsExplained(fit) && Agree(fit.pan, fit.vertical_pan, kMaxPanRatio) &&
         std::abs(fit.vertical_pan) >= kMinSignificance * fit.vertical_pan_error;
}

// A turn moves the images of both sideways cameras the same way, driving moves them opposite ways.
bool IsTurning(const RotationFit& left, const RotationFit& right) {
  return IsExplained(left) && IsExplained(right) && Agree(left.pan, right.pan, kMaxRatioOfBoth);
}

// True if the upper median of the lengths is at least `least`: then half of the vectors, rounded
// up, are at least as long.
bool MedianReaches(const FlowField& field, double least) {
  std::size_t long_enough = 0;
  for (const FlowVector& v : field.vectors) {
    const double squared = v.FlowX() * v.FlowX() + v.FlowY() * v.FlowY();
    long_enough += squared >= least * least ? 1 : 0;
  }
  return long_enough >= field.vectors.size() - field.vectors.size() / 2;
}

}  // namespace

std::optional<bool> HasMoved(const std::array<std::optional<FlowField>, 2>& fields) {
  std::optional<bool> moved;
  for (const std::optional<FlowField>& field : fields) {
    if (field && field->vectors.size() >= kMinVectors) {
      moved = moved.value_or(false) || MedianReaches(*field, kStepFraction * field->width);
    }
  }
  return moved;
}

Motion ClassifyMotion(const ObservedFlow& flow, const std::array<Camera, 2>& cameras) {
  if (!flow.makes_step) {
    return Motion::kStanding;
  }
  std::vector<std::size_t> sides;
  for (std::size_t side = 0; side < 2; ++side) {
    const auto& field = flow.fields[side];
    if (field && field->vectors.size() >= kMinVectors) sides.push_back(side);
  }
  if (sides.empty()) {
    return Motion::kMoving;
  }
  const RotationFit first = FitRotation(*flow.fields[sides[0]], cameras[sides[0]]);
  // Seldom is a drive's flow explained by a turn: then the other camera need not be asked.
  if (!IsExplained(first)) {
    return Motion::kMoving;
  }
  const bool turning =
      sides.size() == 1 ? IsTurning(first)
                        : IsTurning(first, FitRotation(*flow.fields[sides[1]], cameras[sides[1]]));
  return turning ? Motion::kTurning : Motion::kMoving;
}

}  // namespace homing
