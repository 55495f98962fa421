#include "client/source/camera_instants.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/source/live_source.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

// Number of bad frames that are reported one by one.
constexpr std::int64_t kReported = 5;
constexpr double kNanoseconds = 1e9;

// Rates that differ by a smaller fraction count as equal.
constexpr double kSameRate = 0.01;

// Empty if the number of frames is unknown, or so large that the header must be damaged.
FrameKeys TimesAtRate(const FrameSource& camera) {
  constexpr std::int64_t kMost = 10'000'000;
  FrameKeys keys{FrameKeys::Kind::kTime, {}};
  if (camera.promised_size() > kMost) return keys;
  for (std::int64_t i = 0; i < camera.promised_size(); ++i) {
    keys.values.push_back(std::llround(static_cast<double>(i) * kNanoseconds / camera.fps()));
  }
  return keys;
}

bool HasTimes(const FrameSource& camera, const FrameKeys& keys) {
  return camera.live() || camera.fps() > 0 || keys.kind == FrameKeys::Kind::kTime;
}

}  // namespace

CameraInstants::CameraInstants(Cameras cameras, FrameChoice choice)
    : cameras_(std::move(cameras)), choice_(std::move(choice)) {}

absl::StatusOr<std::unique_ptr<CameraInstants>> CameraInstants::Create(Cameras cameras,
                                                                       const FrameChoice& choice) {
  std::string reported;
  for (auto& camera : cameras) {
    if (camera == nullptr) continue;
    // Two topics of one bag have the same remark.
    const std::string remark = camera->remark();
    if (!remark.empty() && remark != reported) choice.report(remark);
    reported = remark;
    if (camera->live()) camera = MakeStoppable(std::move(camera), choice.stop);
  }
  std::unique_ptr<CameraInstants> instants(new CameraInstants(std::move(cameras), choice));
  HOMING_RETURN_IF_ERROR(instants->Pair());
  HOMING_RETURN_IF_ERROR(instants->CheckTimes());
  instants->TakeHoles();
  return instants;
}

absl::Status CameraInstants::Pair() {
  for (std::size_t camera = 0; camera < cameras_.size(); ++camera) {
    if (cameras_[camera] != nullptr) keys_[camera] = cameras_[camera]->keys();
  }
  const auto& [left, right] = cameras_;
  if (left == nullptr || right == nullptr) return absl::OkStatus();
  std::array<FrameKeys, 2> keys = keys_;
  if (left->size() < 0 || right->size() < 0) {
    // Videos of one rate are read side by side.
    const double ratio = left->fps() > 0 && right->fps() > 0 ? left->fps() / right->fps() : 1;
    if (std::abs(ratio - 1) < kSameRate) return absl::OkStatus();
    keys = {TimesAtRate(*left), TimesAtRate(*right)};
    if (keys[0].values.empty() || keys[1].values.empty()) return absl::OkStatus();
  }
  FramePairing pairing = PairFrames(keys[0], left->size(), keys[1], right->size());
  if (pairing.alone[0] + pairing.alone[1] > 0) {
    const std::string text =
        absl::StrCat("the cameras are paired by ", pairing.by, ": ", pairing.alone[0], " of ",
                     left->promised_size(), " frames of --left and ", pairing.alone[1], " of ",
                     right->promised_size(), " of --right have no partner");
    if (choice_.strict) return absl::InvalidArgumentError(text);
    choice_.report(text);
  }
  pairing_ = std::move(pairing);
  return absl::OkStatus();
}

void CameraInstants::TakeHoles() {
  for (std::size_t camera = 0; camera < cameras_.size(); ++camera) {
    const std::vector<std::int64_t> frames = FindHoles(keys_[camera]);
    if (frames.empty()) continue;
    const auto first = static_cast<std::size_t>(frames[0]);
    const std::vector<std::int64_t>& times = keys_[camera].values;
    choice_.report(absl::StrFormat(
        "--%s has no frame for %.1f s before frame %d%s; no step spans a part that is missing",
        kCameraNames[camera], static_cast<double>(times[first] - times[first - 1]) / kNanoseconds,
        frames[0],
        frames.size() == 1 ? "" : absl::StrFormat(", nor at %d more places", frames.size() - 1)));
    if (!pairing_) holes_.insert(holes_.end(), frames.begin(), frames.end());
    for (std::size_t i = 0; pairing_ && i < pairing_->instants.size(); ++i) {
      if (std::binary_search(frames.begin(), frames.end(), pairing_->instants[i][camera])) {
        holes_.push_back(static_cast<std::int64_t>(i));
      }
    }
  }
  std::sort(holes_.begin(), holes_.end());
}

absl::Status CameraInstants::CheckTimes() const {
  if (choice_.fps <= 0 && choice_.seconds <= 0) return absl::OkStatus();
  for (std::size_t camera = 0; camera < cameras_.size(); ++camera) {
    if (cameras_[camera] == nullptr || HasTimes(*cameras_[camera], keys_[camera])) continue;
    return absl::InvalidArgumentError(
        absl::StrCat(choice_.fps > 0 ? "--fps" : "--seconds",
                     " needs frames with times, and the names of --", kCameraNames[camera],
                     " give none; name the files by their time in seconds, or give --every N"));
  }
  return absl::OkStatus();
}

bool CameraInstants::live() const {
  return std::any_of(cameras_.begin(), cameras_.end(),
                     [](const auto& camera) { return camera != nullptr && camera->live(); });
}

std::int64_t CameraInstants::size() const {
  std::int64_t frames = 0;
  for (const auto& camera : cameras_) {
    if (camera == nullptr) continue;
    if (camera->size() < 0) return -1;
    frames = std::max(frames, camera->size());
  }
  if (pairing_) frames = static_cast<std::int64_t>(pairing_->instants.size());
  return (frames + choice_.every - 1) / choice_.every;
}

bool CameraInstants::GoTo(const Place& place) {
  if (live()) return false;
  place_ = place;
  ended_ = false;
  peeked_.reset();
  return true;
}

absl::StatusOr<std::optional<SourceFrame>> CameraInstants::ReadFrame(std::size_t camera,
                                                                     std::int64_t index) {
  FrameSource& source = *cameras_[camera];
  const std::int64_t target = source.size() < 0 ? index : std::min(index, source.size());
  if (position_[camera] != target && !source.live()) {
    if (!source.Seek(target)) {
      return absl::InternalError(absl::StrCat("--", kCameraNames[camera], " has no frame ", index));
    }
    position_[camera] = target;
  }
  auto frame = source.Next();
  // A live camera also delivers the frames in between.
  while (source.live() && frame.ok() && *frame && position_[camera] < index) {
    ++position_[camera];
    frame = source.Next();
  }
  if (frame.ok() && *frame) ++position_[camera];
  return frame;
}

absl::StatusOr<bool> CameraInstants::ReadFrames(std::int64_t index, Instant* instant) {
  std::array<std::int64_t, 2> indices = {index, index};
  if (pairing_) {
    if (index >= static_cast<std::int64_t>(pairing_->instants.size())) return false;
    indices = pairing_->instants[static_cast<std::size_t>(index)];
  }
  instant->index = index;
  bool any = false;
  for (std::size_t camera = 0; camera < cameras_.size(); ++camera) {
    if (cameras_[camera] == nullptr || indices[camera] < 0) continue;
    HOMING_ASSIGN_OR_RETURN(instant->frames[camera], ReadFrame(camera, indices[camera]));
    any = any || instant->frames[camera].has_value();
  }
  return any;
}

void CameraInstants::Report(std::size_t camera, const SourceFrame& frame) {
  if (position_[camera] <= furthest_[camera]) return;
  furthest_[camera] = position_[camera];
  if (++left_out_ == 1) first_fault_ = frame.fault;
  if (left_out_ <= kReported) choice_.report(absl::StrCat("skipped: ", frame.fault));
}

absl::Status CameraInstants::TakeGap(std::size_t camera, Instant* instant) {
  instant->gap_before = true;
  SourceFrame missing;
  missing.fault = absl::StrCat("--", kCameraNames[camera], ": a damaged part before frame ",
                               position_[camera] - 1);
  if (choice_.strict) return absl::InvalidArgumentError(missing.fault);
  Report(camera, missing);
  return absl::OkStatus();
}

absl::Status CameraInstants::DropFaults(Instant* instant) {
  for (std::size_t camera = 0; camera < instant->frames.size(); ++camera) {
    auto& frame = instant->frames[camera];
    if (!frame) continue;
    if (frame->gap_before) HOMING_RETURN_IF_ERROR(TakeGap(camera, instant));
    if (frame->fault.empty()) continue;
    if (choice_.strict) return absl::InvalidArgumentError(frame->fault);
    Report(camera, *frame);
    frame.reset();
  }
  return absl::OkStatus();
}

double CameraInstants::TimeOf(const Instant& instant) {
  for (std::size_t camera = 0; camera < cameras_.size(); ++camera) {
    if (!instant.frames[camera]) continue;
    const auto frame = static_cast<std::size_t>(position_[camera] - 1);
    if (keys_[camera].kind == FrameKeys::Kind::kTime) {
      const std::vector<std::int64_t>& times = keys_[camera].values;
      return static_cast<double>(times[frame] - times[0]) / kNanoseconds;
    }
    if (cameras_[camera]->fps() > 0) return static_cast<double>(frame) / cameras_[camera]->fps();
    const std::int64_t time = instant.frames[camera]->capture_time_ns;
    if (!first_time_ns_) first_time_ns_ = time;
    return static_cast<double>(time - *first_time_ns_) / kNanoseconds;
  }
  return 0;
}

bool CameraInstants::Wanted(const Instant& instant) {
  if (choice_.fps <= 0 && choice_.seconds <= 0) return true;
  // Rounding must not move a frame that lies on the border of a slot.
  constexpr double kSlack = 1e-6;
  const double time = TimeOf(instant);
  if (choice_.seconds > 0 && time >= choice_.seconds - kSlack) {
    ended_ = true;
    return false;
  }
  if (choice_.fps <= 0) return true;
  const auto slot = static_cast<std::int64_t>(std::floor(time * choice_.fps + kSlack));
  if (slot <= place_.slot) return false;
  place_.slot = slot;
  return true;
}

absl::StatusOr<std::optional<CameraInstants::Instant>> CameraInstants::Read() {
  while (!ended_) {
    const std::int64_t index = place_.index;
    const std::int64_t rest = index % choice_.every;
    if (rest != 0) {
      place_.index += choice_.every - rest;
      continue;
    }
    Instant instant;
    const auto hole = std::upper_bound(holes_.begin(), holes_.end(), index - choice_.every);
    place_.gap = place_.gap || (hole != holes_.end() && *hole <= index);
    HOMING_ASSIGN_OR_RETURN(const bool more, ReadFrames(index, &instant));
    if (!more) break;
    HOMING_RETURN_IF_ERROR(DropFaults(&instant));
    ++place_.index;
    place_.gap = place_.gap || instant.gap_before;
    if (!instant.frames[0] && !instant.frames[1]) {
      place_.gap = true;
      continue;
    }
    if (!Wanted(instant)) continue;
    instant.gap_before = std::exchange(place_.gap, false);
    ++used_;
    return std::make_optional(std::move(instant));
  }
  ended_ = true;
  if (used_ == 0 && left_out_ > 0) {
    return absl::InvalidArgumentError(
        absl::StrCat("none of ", left_out_, " frames can be used; the first: ", first_fault_));
  }
  return std::optional<Instant>();
}

absl::StatusOr<std::optional<CameraInstants::Instant>> CameraInstants::Next() {
  if (peeked_) {
    std::optional<Instant> instant = std::move(peeked_);
    peeked_.reset();
    return instant;
  }
  return Read();
}

absl::StatusOr<const CameraInstants::Instant*> CameraInstants::Peek() {
  if (!peeked_) {
    peeked_from_ = place_;
    HOMING_ASSIGN_OR_RETURN(peeked_, Read());
  }
  return peeked_ ? &*peeked_ : nullptr;
}

void CameraInstants::ReportTotal() {
  if (left_out_ > 0) {
    choice_.report(absl::StrCat(std::exchange(left_out_, 0),
                                " bad frames skipped; the first: ", first_fault_));
  }
}

}  // namespace homing::client
