#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "homing/flow/flow_tracker.h"

namespace homing {
namespace {

constexpr int kMaxWorkingWidth = 2048;

struct Interval {
  double low;
  double high;
  // Whether `low` itself is allowed.
  bool closed = true;
};

absl::Status CheckWithin(const std::string& field, double value, const Interval& limit) {
  if (value <= limit.high && (limit.closed ? value >= limit.low : value > limit.low)) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(absl::StrCat("flow.", field, " ", value, " is outside ",
                                                 limit.closed ? "[" : "(", limit.low, ", ",
                                                 limit.high, "]"));
}

absl::Status CheckOdd(const std::string& field, int value) {
  if (value % 2 != 0) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(absl::StrCat("flow.", field, " ", value, " is not odd"));
}

// One corner a cell, each tracked by its window: more of these than kMostWindowPixels allows would
// be left out of an image as high as wide. Eight times as many are accepted, since few cells have
// one.
absl::Status CheckWork(const FlowOptions& options) {
  constexpr double kMost = 8.0 * kMostWindowPixels;
  const int width = options.working_width_px == 0 ? kMaxWorkingWidth : options.working_width_px;
  const double side = static_cast<double>(width) * options.window_px;
  const int least_cell = static_cast<int>(std::ceil(side / std::sqrt(kMost)));
  if (options.cell_px >= least_cell) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat("flow.cell_px ", options.cell_px, " must be at least ", least_cell,
                   " px with a window_px of ", options.window_px, " and a working width of ", width,
                   " px: a pair of frames would take too long"));
}

}  // namespace

absl::Status Validate(const FlowOptions& options) {
  HOMING_RETURN_IF_ERROR(
      CheckWithin("working_width_px", options.working_width_px, {0, kMaxWorkingWidth}));
  if (options.working_width_px != 0) {
    HOMING_RETURN_IF_ERROR(
        CheckWithin("working_width_px", options.working_width_px, {16, kMaxWorkingWidth}));
  }
  HOMING_RETURN_IF_ERROR(CheckWithin("smoothing_sigma_px", options.smoothing_sigma_px, {0, 8}));
  HOMING_RETURN_IF_ERROR(
      CheckWithin("normalization_window_px", options.normalization_window_px, {3, 255}));
  HOMING_RETURN_IF_ERROR(CheckOdd("normalization_window_px", options.normalization_window_px));
  HOMING_RETURN_IF_ERROR(
      CheckWithin("normalization_floor", options.normalization_floor, {0, 64, false}));
  HOMING_RETURN_IF_ERROR(CheckWithin("min_eigenvalue", options.min_eigenvalue, {0, 10, false}));
  HOMING_RETURN_IF_ERROR(CheckWithin("cell_px", options.cell_px, {1, 64}));
  HOMING_RETURN_IF_ERROR(CheckWithin("window_px", options.window_px, {5, 63}));
  HOMING_RETURN_IF_ERROR(CheckOdd("window_px", options.window_px));
  HOMING_RETURN_IF_ERROR(CheckWithin("pyramid_levels", options.pyramid_levels, {0, 6}));
  HOMING_RETURN_IF_ERROR(
      CheckWithin("max_forward_backward_px", options.max_forward_backward_px, {0, 5, false}));
  return CheckWork(options);
}

}  // namespace homing
