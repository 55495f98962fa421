// Validates PositionOptions of position_filter.h.
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"
#include "homing/localization/position_filter.h"

namespace homing {
namespace {

constexpr double kAlmostOne = 1 - 1e-9;

}  // namespace

absl::Status Validate(const PositionOptions& options) {
  HOMING_RETURN_IF_ERROR(CheckRange("tolerance_steps", options.tolerance_steps, 0, 100'000));
  HOMING_RETURN_IF_ERROR(CheckAbove("match_probability", options.match_probability, 0.0, 1.0));
  HOMING_RETURN_IF_ERROR(CheckAbove("unknown_probability", options.unknown_probability, 0.0, 1.0));
  HOMING_RETURN_IF_ERROR(Within("likelihood", Validate(options.likelihood)));
  HOMING_RETURN_IF_ERROR(CheckRange("off_route_prior", options.off_route_prior, 0.0, kAlmostOne));
  return CheckRange("restart_probability", options.restart_probability, 0.0, 0.5);
}

}  // namespace homing
