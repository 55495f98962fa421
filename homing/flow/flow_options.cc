// Validates FlowOptions of flow_tracker.h.
#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"
#include "homing/flow/flow_tracker.h"

namespace homing {
namespace {

constexpr int kMinWorkingWidth = 16;
constexpr int kMaxWorkingWidth = 2048;

absl::Status CheckOddRange(const std::string& field, int value, int low, int high) {
  if (value >= low && value <= high && value % 2 != 0) {
    return absl::OkStatus();
  }
  return MustBe(field, value, absl::StrCat("odd and in [", low, ", ", high, "] px"));
}

// Each cell may have one corner, which is tracked by a window. Of a square image with a corner in
// each cell, at most kMostWindowPixels of window pixels are tracked. Settings with up to eight
// times as many are accepted, since few cells have a corner.
absl::Status CheckWork(const FlowOptions& options) {
  constexpr double kMost = 8.0 * kMostWindowPixels;
  const int width = options.working_width_px == 0 ? kMaxWorkingWidth : options.working_width_px;
  const double side = static_cast<double>(width) * options.window_px;
  const int least_cell = static_cast<int>(std::ceil(side / std::sqrt(kMost)));
  if (options.cell_px >= least_cell) {
    return absl::OkStatus();
  }
  return MustBe("cell_px", options.cell_px,
                absl::StrCat("at least ", least_cell, " px with a window_px of ", options.window_px,
                             " and a working width of ", width, " px"));
}

}  // namespace

absl::Status Validate(const FlowOptions& options) {
  const int width = options.working_width_px;
  if (width != 0 && (width < kMinWorkingWidth || width > kMaxWorkingWidth)) {
    return MustBe("working_width_px", width,
                  absl::StrCat("0 or in [", kMinWorkingWidth, ", ", kMaxWorkingWidth, "] px"));
  }
  HOMING_RETURN_IF_ERROR(
      CheckRange("smoothing_sigma_px", options.smoothing_sigma_px, 0.0, 8.0, "px"));
  HOMING_RETURN_IF_ERROR(
      CheckOddRange("normalization_window_px", options.normalization_window_px, 3, 255));
  HOMING_RETURN_IF_ERROR(
      CheckAbove("normalization_floor", options.normalization_floor, 0.0, 64.0, "grey levels"));
  HOMING_RETURN_IF_ERROR(CheckAbove("min_eigenvalue", options.min_eigenvalue, 0.0, 10.0));
  HOMING_RETURN_IF_ERROR(CheckRange("cell_px", options.cell_px, 1, 64, "px"));
  HOMING_RETURN_IF_ERROR(CheckOddRange("window_px", options.window_px, 5, 63));
  HOMING_RETURN_IF_ERROR(CheckRange("pyramid_levels", options.pyramid_levels, 0, 6));
  HOMING_RETURN_IF_ERROR(
      CheckAbove("max_forward_backward_px", options.max_forward_backward_px, 0.0, 5.0, "px"));
  return CheckWork(options);
}

}  // namespace homing
