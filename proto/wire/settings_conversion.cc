#include "proto/wire/settings_conversion.h"

#include <algorithm>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"

namespace homing::wire {
namespace {

constexpr int kMaxSidePx = 8192;

absl::Status CheckSide(int value, const std::string& field) {
  return CheckRange(field, value, 0, kMaxSidePx, "px");
}

}  // namespace

absl::StatusOr<Camera> FromProto(const v1::Camera& message, const std::string& field) {
  HOMING_RETURN_IF_ERROR(CheckSide(message.width(), absl::StrCat(field, ".width")));
  HOMING_RETURN_IF_ERROR(CheckSide(message.height(), absl::StrCat(field, ".height")));
  Camera camera;
  camera.width = message.width();
  camera.height = message.height();
  const Intrinsics intrinsics{message.focal_x(), message.focal_y(), message.center_x(),
                              message.center_y()};
  if (intrinsics != Intrinsics{}) camera.intrinsics = intrinsics;
  const int given = message.distortion_size();
  camera.fisheye = message.fisheye();
  if (given != 0 && given != 4 && (camera.fisheye || (given != 5 && given != 8))) {
    return MustBe(absl::StrCat(field, ".distortion"), given,
                  camera.fisheye ? "0 or 4 entries" : "0, 4, 5 or 8 entries");
  }
  std::copy(message.distortion().begin(), message.distortion().end(), camera.distortion.begin());
  camera.yaw_rad = message.yaw_rad();
  HOMING_RETURN_IF_ERROR(Within(field, Validate(camera)));
  return camera;
}

absl::StatusOr<FlowOptions> FromProto(const v1::FlowSettings& message, const std::string& field) {
  FlowOptions options;
  options.working_width_px = message.working_width_px();
  options.smoothing_sigma_px = message.smoothing_sigma_px();
  options.normalization_window_px = message.normalization_window_px();
  options.normalization_floor = message.normalization_floor();
  options.min_eigenvalue = message.min_eigenvalue();
  options.cell_px = message.cell_px();
  options.window_px = message.window_px();
  options.pyramid_levels = message.pyramid_levels();
  options.max_forward_backward_px = message.max_forward_backward_px();
  HOMING_RETURN_IF_ERROR(Within(field, Validate(options)));
  return options;
}

absl::StatusOr<LandmarkOptions> FromProto(const v1::LandmarkSettings& message,
                                          const std::string& field) {
  LandmarkOptions options;
  options.min_vector_length_px = message.min_vector_length_px();
  options.min_vectors = message.min_vectors();
  options.histogram_bins = message.histogram_bins();
  options.max_valley_ratio = message.max_valley_ratio();
  options.min_peak_share = message.min_peak_share();
  options.max_track_distance_px = message.max_track_distance_px();
  options.max_track_gap_steps = message.max_track_gap_steps();
  HOMING_RETURN_IF_ERROR(Within(field, Validate(options)));
  return options;
}

absl::StatusOr<JourneySettings> FromProto(const v1::JourneySettings& message,
                                          const std::string& field,
                                          const JourneySettings& defaults) {
  JourneySettings settings = defaults;
  if (message.has_left_camera()) {
    HOMING_ASSIGN_OR_RETURN(settings.cameras[0],
                            FromProto(message.left_camera(), absl::StrCat(field, ".left_camera")));
  }
  if (message.has_right_camera()) {
    HOMING_ASSIGN_OR_RETURN(settings.cameras[1], FromProto(message.right_camera(),
                                                           absl::StrCat(field, ".right_camera")));
  }
  if (message.has_flow()) {
    HOMING_ASSIGN_OR_RETURN(settings.flow, FromProto(message.flow(), absl::StrCat(field, ".flow")));
  }
  if (message.has_landmark()) {
    HOMING_ASSIGN_OR_RETURN(settings.landmark,
                            FromProto(message.landmark(), absl::StrCat(field, ".landmark")));
  }
  if (!message.deviation_model().empty()) {
    settings.deviation_model_name = message.deviation_model();
  }
  return settings;
}

v1::Camera ToProto(const Camera& camera) {
  v1::Camera message;
  message.set_width(camera.width);
  message.set_height(camera.height);
  if (camera.intrinsics) {
    message.set_focal_x(camera.intrinsics->focal_x);
    message.set_focal_y(camera.intrinsics->focal_y);
    message.set_center_x(camera.intrinsics->center_x);
    message.set_center_y(camera.intrinsics->center_y);
  }
  if (camera.distortion != decltype(camera.distortion){}) {
    // As many as the model has.
    const auto more = std::find_if(camera.distortion.begin() + 5, camera.distortion.end(),
                                   [](double k) { return k != 0; });
    const int count = camera.fisheye ? 4 : more == camera.distortion.end() ? 5 : 8;
    message.mutable_distortion()->Add(camera.distortion.begin(), camera.distortion.begin() + count);
  }
  message.set_yaw_rad(camera.yaw_rad);
  message.set_fisheye(camera.fisheye);
  return message;
}

v1::FlowSettings ToProto(const FlowOptions& options) {
  v1::FlowSettings message;
  message.set_working_width_px(options.working_width_px);
  message.set_smoothing_sigma_px(options.smoothing_sigma_px);
  message.set_normalization_window_px(options.normalization_window_px);
  message.set_normalization_floor(options.normalization_floor);
  message.set_min_eigenvalue(options.min_eigenvalue);
  message.set_cell_px(options.cell_px);
  message.set_window_px(options.window_px);
  message.set_pyramid_levels(options.pyramid_levels);
  message.set_max_forward_backward_px(options.max_forward_backward_px);
  return message;
}

v1::LandmarkSettings ToProto(const LandmarkOptions& options) {
  v1::LandmarkSettings message;
  message.set_min_vector_length_px(options.min_vector_length_px);
  message.set_min_vectors(options.min_vectors);
  message.set_histogram_bins(options.histogram_bins);
  message.set_max_valley_ratio(options.max_valley_ratio);
  message.set_min_peak_share(options.min_peak_share);
  message.set_max_track_distance_px(options.max_track_distance_px);
  message.set_max_track_gap_steps(options.max_track_gap_steps);
  return message;
}

v1::JourneySettings ToProto(const JourneySettings& settings) {
  v1::JourneySettings message;
  *message.mutable_left_camera() = ToProto(settings.cameras[0]);
  *message.mutable_right_camera() = ToProto(settings.cameras[1]);
  *message.mutable_flow() = ToProto(settings.flow);
  *message.mutable_landmark() = ToProto(settings.landmark);
  message.set_deviation_model(settings.deviation_model_name);
  return message;
}

}  // namespace homing::wire
