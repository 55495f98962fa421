#include "homing/flow/observation.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"
#include "homing/base/vector_clones.h"

namespace homing {
namespace {

std::string NameOf(std::size_t side) { return side == 0 ? "left" : "right"; }

absl::Status WithSide(const absl::Status& status, std::size_t side) {
  return Within(NameOf(side), status);
}

// Finite, and no further off the image than its own size.
bool IsPlausible(float p, int side) {
  return (p >= -static_cast<float>(side)) & (p <= 2 * static_cast<float>(side));
}

// All vectors; without a branch for each.
HOMING_VECTOR_CLONES
bool ArePlausible(const FlowField& field) {
  std::int32_t beyond = 0;
  const int width = field.width, height = field.height;
  for (const FlowVector& v : field.vectors) {
    beyond |= IsPlausible(v.start_x, width) ? 0 : 1;
    beyond |= IsPlausible(v.start_y, height) ? 0 : 1;
    beyond |= IsPlausible(v.end_x, width) ? 0 : 1;
    beyond |= IsPlausible(v.end_y, height) ? 0 : 1;
  }
  return beyond == 0;
}

absl::Status CheckVector(const FlowField& field, std::size_t index) {
  const FlowVector& v = field.vectors[index];
  if (IsPlausible(v.start_x, field.width) && IsPlausible(v.end_x, field.width) &&
      IsPlausible(v.start_y, field.height) && IsPlausible(v.end_y, field.height)) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat("flow_vectors[", index, "] (", v.start_x, ", ", v.start_y, ") to (", v.end_x,
                   ", ", v.end_y, ") is not finite or over one image size outside the image of ",
                   field.width, " x ", field.height, " px"));
}

absl::Status CheckField(const FlowField& field, const DecodeLimits& limits) {
  for (const int side : {field.width, field.height}) {
    if (side < limits.min_side_px || side > limits.max_side_px) {
      return absl::InvalidArgumentError(absl::StrCat(
          "flow_vectors of an image of ", field.width, " x ", field.height,
          " px: sides must be in [", limits.min_side_px, ", ", limits.max_side_px, "] px"));
    }
  }
  if (field.vectors.size() > kMaxFlowVectors) {
    return absl::InvalidArgumentError(absl::StrCat("flow_vectors has ", field.vectors.size(),
                                                   " vectors, the limit is ", kMaxFlowVectors));
  }
  if (!ArePlausible(field)) {
    for (std::size_t i = 0; i < field.vectors.size(); ++i) {
      HOMING_RETURN_IF_ERROR(CheckVector(field, i));
    }
  }
  return absl::OkStatus();
}

// `known` is 0 x 0 before the camera's first view.
absl::Status CheckSameSize(const cv::Size& size, const cv::Size& known) {
  if (known.area() == 0 || size == known) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(absl::StrCat("image of ", size.width, " x ", size.height,
                                                 " px, the camera's images before had ",
                                                 known.width, " x ", known.height, " px"));
}

absl::Status CheckCameraSize(const cv::Size& size, const Camera& camera) {
  if (size.area() == 0 || camera.width == 0 || size == cv::Size(camera.width, camera.height)) {
    return absl::OkStatus();
  }
  return absl::FailedPreconditionError(absl::StrCat("image of ", size.width, " x ", size.height,
                                                    " px, the journey's camera has ", camera.width,
                                                    " x ", camera.height, " px"));
}

}  // namespace

ObservationFlow::ObservationFlow(const FlowOptions& options, const DecodeLimits& limits)
    : options_(options), limits_(limits) {}

absl::StatusOr<ObservationFlow::CheckedView> ObservationFlow::Check(const CameraView& view,
                                                                    std::size_t side) const {
  CheckedView checked;
  if (const auto* frame = std::get_if<Frame>(&view)) {
    HOMING_ASSIGN_OR_RETURN(checked.gray, DecodeGray(*frame, limits_));
    checked.size = checked.gray.size();
  } else if (const auto* field = std::get_if<FlowField>(&view)) {
    HOMING_RETURN_IF_ERROR(CheckField(*field, limits_));
    checked.size = cv::Size(field->width, field->height);
  } else {
    return checked;
  }
  HOMING_RETURN_IF_ERROR(CheckSameSize(checked.size, sizes_[side]));
  return checked;
}

absl::StatusOr<ObservedFlow> ObservationFlow::Compute(const Observation& observation) {
  return Compute(observation, {});
}

absl::StatusOr<ObservedFlow> ObservationFlow::Compute(const Observation& observation,
                                                      const std::array<Camera, 2>& cameras) {
  std::array<CheckedView, 2> checked;
  for (std::size_t side = 0; side < 2; ++side) {
    absl::StatusOr<CheckedView> view = Check(observation.views[side], side);
    if (!view.ok()) {
      return WithSide(view.status(), side);
    }
    checked[side] = *std::move(view);
    HOMING_RETURN_IF_ERROR(WithSide(CheckCameraSize(checked[side].size, cameras[side]), side));
  }
  if (checked[0].size.area() == 0 && checked[1].size.area() == 0) {
    return absl::InvalidArgumentError("observation has neither a left nor a right view");
  }
  // Nothing below fails.
  ObservedFlow flow;
  for (std::size_t side = 0; side < 2; ++side) {
    HOMING_ASSIGN_OR_RETURN(flow.fields[side], Take(observation.views[side], checked[side], side,
                                                    observation.break_before));
  }
  return flow;
}

void ObservationFlow::FillSizes(std::array<Camera, 2>& cameras) const {
  for (std::size_t side = 0; side < 2; ++side) {
    if (cameras[side].width == 0) {
      cameras[side].width = sizes_[side].width;
      cameras[side].height = sizes_[side].height;
    }
  }
}

absl::StatusOr<std::optional<FlowField>> ObservationFlow::Take(const CameraView& view,
                                                               const CheckedView& checked,
                                                               std::size_t side,
                                                               bool break_before) {
  if (checked.size.area() != 0) {
    sizes_[side] = checked.size;
  }
  std::optional<FlowTracker>& tracker = trackers_[side];
  if (tracker && (break_before || checked.gray.empty())) {
    tracker->Reset();
  }
  if (const auto* field = std::get_if<FlowField>(&view)) {
    // The flow between the frame before a break and the one after it is none.
    return break_before ? std::nullopt : std::optional<FlowField>(*field);
  }
  if (checked.gray.empty()) {
    return std::nullopt;
  }
  if (!tracker) {
    tracker.emplace(options_);
  }
  absl::StatusOr<std::optional<FlowField>> field = tracker->Track(checked.gray);
  tracker->Advance();
  return field;
}

}  // namespace homing
