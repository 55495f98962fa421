#include "homing/flow/observation.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"
#include "homing/base/vector_clones.h"
#include "homing/flow/motion.h"

namespace homing {
namespace {

absl::Status WithSide(const absl::Status& status, std::size_t side) {
  return Within(kCameraNames[side], status);
}

// True if finite and at most one image size outside the image.
bool IsPlausible(float p, int side) {
  return (p >= -static_cast<float>(side)) & (p <= 2 * static_cast<float>(side));
}

// Checks all vectors with no branch for each vector.
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
  return MustBe(
      absl::StrCat("flow_vectors[", index, "]"),
      absl::StrCat("(", v.start_x, ", ", v.start_y, ") to (", v.end_x, ", ", v.end_y, ")"),
      absl::StrCat("finite and within one image size of the image of ", field.width, " x ",
                   field.height, " px"));
}

absl::Status CheckField(const FlowField& field, const DecodeLimits& limits) {
  HOMING_RETURN_IF_ERROR(
      CheckRange("flow_vectors.width", field.width, limits.min_side_px, limits.max_side_px, "px"));
  HOMING_RETURN_IF_ERROR(CheckRange("flow_vectors.height", field.height, limits.min_side_px,
                                    limits.max_side_px, "px"));
  if (field.vectors.size() > kMaxFlowVectors) {
    return MustBe("flow_vectors", field.vectors.size(),
                  absl::StrCat("at most ", kMaxFlowVectors, " vectors"));
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
  return absl::InvalidArgumentError(
      absl::StrCat("image of ", size.width, " x ", size.height, " px must have the ", known.width,
                   " x ", known.height, " px of the camera's earlier images"));
}

absl::Status CheckCameraSize(const cv::Size& size, const Camera& camera) {
  if (size.area() == 0 || camera.width == 0 || size == cv::Size(camera.width, camera.height)) {
    return absl::OkStatus();
  }
  return absl::FailedPreconditionError(absl::StrCat("image of ", size.width, " x ", size.height,
                                                    " px must have the ", camera.width, " x ",
                                                    camera.height, " px of the journey's camera"));
}

bool IsStill(const FlowField& field) {
  return std::all_of(field.vectors.begin(), field.vectors.end(),
                     [](const FlowVector& v) { return v.FlowX() == 0 && v.FlowY() == 0; });
}

// Sets makes_step; `otherwise` where the fields have too few vectors. Of a camera that shows
// exactly no motion while the other one's image moves, the driver has frozen: it repeats one image,
// and its vectors would deny the motion.
void DecideStep(ObservedFlow& flow, bool otherwise) {
  flow.makes_step = HasMoved(flow.fields).value_or(otherwise);
  if (!flow.makes_step) return;
  for (std::optional<FlowField>& field : flow.fields) {
    if (field && field->vectors.size() >= kMinVectors && IsStill(*field)) field.reset();
  }
}

// Copies the flow vectors; drops those that span a break.
ObservedFlow PassOn(const Observation& observation) {
  ObservedFlow flow;
  bool has_field = false;
  for (std::size_t side = 0; side < 2; ++side) {
    const auto* field = std::get_if<FlowField>(&observation.views[side]);
    if (field == nullptr || observation.break_before) continue;
    flow.fields[side] = *field;
    has_field = true;
  }
  DecideStep(flow, has_field);
  return flow;
}

}  // namespace

absl::Status NoCameraError() { return FieldError("left", "must be set unless right is"); }

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
  CheckedViews checked;
  for (std::size_t side = 0; side < 2; ++side) {
    absl::StatusOr<CheckedView> view = Check(observation.views[side], side);
    if (!view.ok()) {
      return WithSide(view.status(), side);
    }
    checked[side] = *std::move(view);
    HOMING_RETURN_IF_ERROR(WithSide(CheckCameraSize(checked[side].size, cameras[side]), side));
  }
  if (checked[0].size.area() == 0 && checked[1].size.area() == 0) {
    return NoCameraError();
  }
  // From here on nothing fails, except by cancellation.
  for (std::size_t side = 0; side < 2; ++side) {
    if (checked[side].size.area() != 0) sizes_[side] = checked[side].size;
  }
  if (observation.break_before) ForgetReference();
  if (checked[0].gray.empty() && checked[1].gray.empty()) {
    return PassOn(observation);
  }
  HOMING_ASSIGN_OR_RETURN(ObservedFlow flow, TrackFrames(checked));
  // Without common corners no flow can be measured from this reference any more: replace it.
  if (flow.makes_step || !HasMoved(flow.fields)) {
    Advance(checked);
    reference_sequence_ = observation.sequence;
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

void ObservationFlow::ForgetReference() {
  for (std::optional<FlowTracker>& tracker : trackers_) {
    if (tracker) tracker->Reset();
  }
}

absl::StatusOr<ObservedFlow> ObservationFlow::TrackFrames(const CheckedViews& checked) {
  ObservedFlow flow;
  // Both frames of a camera have corners, but almost none could be tracked.
  bool lost = false;
  for (std::size_t side = 0; side < 2; ++side) {
    if (checked[side].gray.empty()) continue;
    std::optional<FlowTracker>& tracker = trackers_[side];
    if (!tracker) tracker.emplace(options_);
    HOMING_ASSIGN_OR_RETURN(flow.fields[side],
                            tracker->Track(checked[side].gray, limits_.cancellation));
    if (flow.fields[side]) {
      lost = lost ||
             (tracker->reference_corners() >= kMinVectors && tracker->corners() >= kMinVectors);
    }
  }
  DecideStep(flow, lost);
  return flow;
}

void ObservationFlow::Advance(const CheckedViews& checked) {
  for (std::size_t side = 0; side < 2; ++side) {
    if (!trackers_[side]) continue;
    if (checked[side].gray.empty()) {
      trackers_[side]->Reset();
    } else {
      trackers_[side]->Advance();
    }
  }
}

}  // namespace homing
