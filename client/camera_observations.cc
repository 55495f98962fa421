#include "client/camera_observations.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
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

CameraObservations::CameraObservations(std::unique_ptr<CameraInstants> instants,
                                       const std::optional<FlowOptions>& flow)
    : instants_(std::move(instants)), flow_options_(flow) {
  Forget();
}

void CameraObservations::Forget() {
  if (flow_options_) flow_.emplace(*flow_options_);
  had_ = {};
}

std::int64_t CameraObservations::read_count() const {
  const MutexLock lock(mutex_);
  return static_cast<std::int64_t>(marks_.size());
}

void CameraObservations::AddMark(const Mark& mark) {
  const MutexLock lock(mutex_);
  marks_.push_back(mark);
}

std::int64_t CameraObservations::FrameOf(std::int64_t sequence) const {
  const MutexLock lock(mutex_);
  const std::int64_t own = sequence - base_;
  if (own < 0 || own >= static_cast<std::int64_t>(marks_.size())) return -1;
  return marks_[static_cast<std::size_t>(own)].frame;
}

absl::StatusOr<std::optional<CameraInstants::Instant>> CameraObservations::NextInstant(
    std::optional<ObservedFlow>* flow) {
  while (true) {
    const CameraInstants::Place here = instants_->place();
    HOMING_ASSIGN_OR_RETURN(auto instant, instants_->Next());
    if (!instant) return instant;
    if (instant->gap_before) {
      Forget();
      break_ = read_count() > 0;
    }
    bool has_flow = false;
    for (std::size_t camera = 0; camera < had_.size(); ++camera) {
      has_flow = has_flow || (had_[camera] && instant->frames[camera]);
      had_[camera] = instant->frames[camera].has_value();
    }
    if (flow != nullptr) {
      auto computed = flow_->Compute(ViewFrames(instant->frames));
      if (!computed.ok()) {
        return Within(absl::StrCat("observation[", next_, "]"), computed.status());
      }
      *flow = *std::move(computed);
    }
    const CameraInstants::Place from = flow_ ? std::exchange(before_, here) : here;
    // The first frame of a camera has no flow; it makes no observation.
    if (flow_ && !has_flow) continue;
    AddMark({from, instant->index});
    return instant;
  }
}

absl::StatusOr<std::optional<Observation>> CameraObservations::NextFlow() {
  std::optional<ObservedFlow> flow;
  HOMING_ASSIGN_OR_RETURN(const auto instant, NextInstant(&flow));
  if (!instant) return std::optional<Observation>();
  Observation observation = ViewFrames(instant->frames);
  for (std::size_t camera = 0; camera < flow->fields.size(); ++camera) {
    observation.views[camera] = std::monostate();
    if (flow->fields[camera]) observation.views[camera] = *std::move(flow->fields[camera]);
  }
  return std::make_optional(std::move(observation));
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
  HOMING_ASSIGN_OR_RETURN(const auto instant, NextInstant(nullptr));
  if (!instant) return std::optional<v1::Observation>();
  return std::make_optional(Number(ViewFrames(instant->frames)));
}

bool CameraObservations::Seek(std::int64_t sequence) {
  const std::int64_t own = sequence - base_;
  if (own < 0 || instants_->live()) return false;
  std::optional<CameraInstants::Place> from;
  {
    const MutexLock lock(mutex_);
    if (own < static_cast<std::int64_t>(marks_.size())) {
      from = marks_[static_cast<std::size_t>(own)].from;
      marks_.resize(static_cast<std::size_t>(own));
    }
  }
  if (from) {
    Forget();
    if (!instants_->GoTo(*from)) return false;
  }
  // Which frames are bad is known only after they were read. The last one's flow is computed, since
  // the next one needs its frames.
  while (read_count() < own) {
    std::optional<ObservedFlow> flow;
    const bool last = flow_ && read_count() + 1 == own;
    const auto instant = NextInstant(last ? &flow : nullptr);
    // Next gives the error again.
    if (!instant.ok() || !*instant) break;
  }
  next_ = sequence;
  break_ = false;
  return true;
}

void CameraObservations::ContinueAt(std::int64_t sequence) {
  if (!Seek(sequence)) {
    Forget();
    base_ = sequence - read_count();
    next_ = sequence;
  }
  break_ = true;
}

std::int64_t CameraObservations::size() const {
  const std::int64_t frames = instants_->size();
  if (frames < 0) return -1;
  return base_ + (flow_ ? std::max<std::int64_t>(frames - 1, 0) : frames);
}

}  // namespace homing::client
