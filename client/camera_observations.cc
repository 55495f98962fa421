#include "client/camera_observations.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"
#include "proto/wire/observation_conversion.h"

namespace homing::client {
namespace {

std::int64_t CaptureTime(const std::array<std::optional<SourceFrame>, 2>& frames) {
  for (const auto& frame : frames) {
    if (frame && frame->capture_time_ns != 0) return frame->capture_time_ns;
  }
  return 0;
}

Observation ViewFrames(const std::array<std::optional<SourceFrame>, 2>& frames) {
  Observation observation;
  for (std::size_t camera = 0; camera < frames.size(); ++camera) {
    if (frames[camera]) observation.views[camera] = frames[camera]->view();
  }
  observation.capture_time_ns = CaptureTime(frames);
  return observation;
}

}  // namespace

absl::StatusOr<Cameras> OpenCameras(const std::string& left, const std::string& right) {
  if (left.empty() && right.empty()) {
    return absl::InvalidArgumentError("no camera: give --left, --right or both");
  }
  Cameras cameras;
  if (!left.empty()) {
    HOMING_ASSIGN_OR_RETURN(cameras[0], OpenFrameSource(left, Side::kLeft));
  }
  if (!right.empty()) {
    HOMING_ASSIGN_OR_RETURN(cameras[1], OpenFrameSource(right, Side::kRight));
  }
  return cameras;
}

CameraObservations::CameraObservations(Cameras cameras, const std::optional<FlowOptions>& flow)
    : cameras_(std::move(cameras)), flow_options_(flow) {
  ForgetLastFrame();
}

void CameraObservations::ForgetLastFrame() {
  if (flow_options_) flow_.emplace(*flow_options_);
}

absl::StatusOr<std::optional<CameraObservations::Instant>> CameraObservations::NextInstant() {
  Instant instant;
  for (std::size_t camera = 0; camera < cameras_.size(); ++camera) {
    if (cameras_[camera] == nullptr) continue;
    HOMING_ASSIGN_OR_RETURN(instant[camera], cameras_[camera]->Next());
  }
  if (!instant[0] && !instant[1]) return std::optional<Instant>();
  return std::make_optional(std::move(instant));
}

absl::StatusOr<std::optional<Observation>> CameraObservations::NextFlow() {
  while (true) {
    HOMING_ASSIGN_OR_RETURN(const auto instant, NextInstant());
    if (!instant) return std::optional<Observation>();
    Observation frames = ViewFrames(*instant);
    auto flow_or = flow_->Compute(frames);
    if (!flow_or.ok()) return Within(absl::StrCat("observation[", next_, "]"), flow_or.status());
    ObservedFlow flow = *std::move(flow_or);
    // The first frame has no flow and makes no observation.
    if (!flow.fields[0] && !flow.fields[1]) continue;
    for (std::size_t camera = 0; camera < flow.fields.size(); ++camera) {
      frames.views[camera] = std::monostate();
      if (flow.fields[camera]) frames.views[camera] = *std::move(flow.fields[camera]);
    }
    return std::make_optional(std::move(frames));
  }
}

v1::Observation CameraObservations::Number(Observation observation) {
  observation.sequence = next_++;
  observation.break_before = std::exchange(break_, false);
  return wire::ToProto(observation);
}

absl::StatusOr<std::optional<v1::Observation>> CameraObservations::Next() {
  if (flow_) {
    HOMING_ASSIGN_OR_RETURN(auto flow, NextFlow());
    if (!flow) return std::optional<v1::Observation>();
    return std::make_optional(Number(*std::move(flow)));
  }
  HOMING_ASSIGN_OR_RETURN(const auto instant, NextInstant());
  if (!instant) return std::optional<v1::Observation>();
  return std::make_optional(Number(ViewFrames(*instant)));
}

bool CameraObservations::Seek(std::int64_t sequence) {
  for (const auto& camera : cameras_) {
    if (camera == nullptr) continue;
    const std::int64_t size = camera->size();
    if (!camera->Seek(size < 0 ? sequence : std::min(sequence, size))) return false;
  }
  ForgetLastFrame();
  next_ = sequence;
  break_ = false;
  return true;
}

void CameraObservations::ContinueAt(std::int64_t sequence) {
  ForgetLastFrame();
  next_ = sequence;
  break_ = true;
}

std::int64_t CameraObservations::size() const {
  std::int64_t frames = 0;
  for (const auto& camera : cameras_) {
    if (camera == nullptr) continue;
    if (camera->size() < 0) return -1;
    frames = std::max(frames, camera->size());
  }
  return flow_ ? std::max<std::int64_t>(frames - 1, 0) : frames;
}

}  // namespace homing::client
