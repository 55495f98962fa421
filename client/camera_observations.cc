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
  if (cameras[0] != nullptr && cameras[1] != nullptr && !cameras[0]->name().empty() &&
      cameras[0]->name() == cameras[1]->name()) {
    return absl::InvalidArgumentError(
        absl::StrCat("both cameras would take ", cameras[0]->name(), "; name two topics"));
  }
  return cameras;
}

CameraObservations::CameraObservations(std::unique_ptr<CameraInstants> instants,
                                       const std::optional<FlowOptions>& flow)
    : instants_(std::move(instants)), flow_options_(flow) {
  Forget();
}

void CameraObservations::StartAt(std::int64_t sequence) {
  base_ = next_ = sequence;
  const MutexLock lock(mutex_);
  marks_from_ = sequence;
}

void CameraObservations::Forget() {
  if (flow_options_) flow_.emplace(*flow_options_);
  reference_.reset();
}

std::int64_t CameraObservations::next_mark() const {
  const MutexLock lock(mutex_);
  return marks_from_ + static_cast<std::int64_t>(marks_.size());
}

void CameraObservations::AddMark(const Mark& mark) {
  const MutexLock lock(mutex_);
  marks_.push_back(mark);
}

std::int64_t CameraObservations::FrameOf(std::int64_t sequence) const {
  const MutexLock lock(mutex_);
  const std::int64_t index = sequence - marks_from_;
  if (index < 0 || index >= static_cast<std::int64_t>(marks_.size())) return -1;
  return marks_[static_cast<std::size_t>(index)].frame;
}

absl::StatusOr<std::optional<CameraInstants::Instant>> CameraObservations::ReadInstant() {
  // A stop ends a live source by itself, without an error.
  if (stop_.stop_requested() && !instants_->live()) return absl::CancelledError("stopped");
  here_ = {instants_->place(), count_};
  HOMING_ASSIGN_OR_RETURN(auto instant, instants_->Next());
  if (!instant) return instant;
  if (instant->gap_before) {
    Forget();
    // Flow is sent only where it spans no gap.
    break_ = !flow_ && count_ > 0;
  }
  ++count_;
  return instant;
}

absl::StatusOr<std::optional<Observation>> CameraObservations::NextFlow() {
  while (true) {
    HOMING_ASSIGN_OR_RETURN(const auto instant, ReadInstant());
    if (!instant) return std::optional<Observation>();
    if (!reference_) reference_ = here_;
    Observation observation = ViewFrames(instant->frames);
    auto computed = flow_->Compute(observation);
    if (!computed.ok()) {
      return Within(absl::StrCat("frame[", instant->index, "]"), computed.status());
    }
    ObservedFlow flow = *std::move(computed);
    if (!flow.makes_step) continue;
    AddMark({*std::exchange(reference_, here_), instant->index});
    observation.frame = base_frame_ + here_.count;
    for (std::size_t camera = 0; camera < flow.fields.size(); ++camera) {
      observation.views[camera] = std::monostate();
      if (flow.fields[camera]) observation.views[camera] = *std::move(flow.fields[camera]);
    }
    return std::make_optional(std::move(observation));
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
  HOMING_ASSIGN_OR_RETURN(const auto instant, ReadInstant());
  if (!instant) return std::optional<v1::Observation>();
  AddMark({here_, instant->index});
  return std::make_optional(Number(ViewFrames(instant->frames)));
}

bool CameraObservations::Skip() {
  if (flow_) {
    const auto next = NextFlow();
    return next.ok() && next->has_value();
  }
  const auto instant = ReadInstant();
  if (!instant.ok() || !*instant) return false;
  AddMark({here_, (*instant)->index});
  return true;
}

bool CameraObservations::GoTo(const Point& point) {
  if (!instants_->GoTo(point.place)) return false;
  Forget();
  count_ = point.count;
  return true;
}

bool CameraObservations::GoBack(std::int64_t sequence) {
  Point from;
  {
    const MutexLock lock(mutex_);
    const std::int64_t index = sequence - marks_from_;
    if (index >= static_cast<std::int64_t>(marks_.size())) return true;
    if (index < 0) {
      marks_from_ = base_;
      marks_.clear();
    } else {
      from = marks_[static_cast<std::size_t>(index)].from;
      marks_.resize(static_cast<std::size_t>(index));
    }
  }
  return GoTo(from);
}

// The frame that made the last step is then the reference. The frames before it are read, since
// only that shows which ones are bad, but not tracked.
void CameraObservations::SkipToLastFrame(std::int64_t sequence) {
  while (count_ < last_frame_) {
    const auto instant = ReadInstant();
    if (!instant.ok() || !*instant) break;
  }
  Forget();
  const MutexLock lock(mutex_);
  marks_from_ = sequence;
  marks_.clear();
}

bool CameraObservations::Seek(std::int64_t sequence) {
  if (sequence < base_ || instants_->live() || !GoBack(sequence)) return false;
  // If there were no earlier sources, the frame's number is its count.
  const bool begins = flow_ && base_ == 0 && count_ == 0;
  if (begins && sequence > 0 && last_frame_ >= 0) SkipToLastFrame(sequence);
  // Which frames make an observation is known only after they were read.
  while (next_mark() < sequence && Skip()) {
  }
  if (base_ > 0 && base_frame_ == 0 && last_frame_ >= 0) {
    base_frame_ = reference_ ? last_frame_ - reference_->count : last_frame_ + 1;
  }
  next_ = sequence;
  break_ = false;
  return true;
}

void CameraObservations::ContinueAt(std::int64_t sequence) {
  if (!Seek(sequence)) {
    Forget();
    next_ = sequence;
    base_frame_ = std::max(base_frame_, last_frame_ + 1 - count_);
    const MutexLock lock(mutex_);
    marks_from_ = sequence;
    marks_.clear();
  }
  break_ = !flow_;
}

std::int64_t CameraObservations::size() const {
  const std::int64_t instants = instants_->size();
  return instants < 0 ? -1 : base_ + instants;
}

}  // namespace homing::client
