#include "server/session/recording_session.h"

#include <algorithm>
#include <array>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/mutex.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"
#include "server/base/error_reason.h"
#include "server/session/image_memory.h"
#include "server/session/sequence_check.h"

namespace homing::server {
namespace {

// The part of the settings that an observation may change.
std::array<int, 4> ImageSizes(const JourneySettings& settings) {
  const auto& [left, right] = settings.cameras;
  return {left.width, left.height, right.width, right.height};
}

}  // namespace

absl::StatusOr<std::shared_ptr<RecordingSession>> RecordingSession::Open(
    const RecordingContext& context, const std::string& journey, const std::string& writer_id,
    TimePoint now, RecordingListener listener) {
  HOMING_ASSIGN_OR_RETURN(const JourneyName name, ParseJourneyName(journey, "config.journey"));
  HOMING_RETURN_IF_ERROR(CheckWriterId(writer_id, "config.writer_id"));
  if (writer_id.empty()) {
    return FieldError("config.writer_id", "must name the writer");
  }
  std::shared_ptr<RecordingSession> session(new RecordingSession(context, std::move(listener)));
  HOMING_ASSIGN_OR_RETURN(WriterClaim claim,
                          context.catalog->Claim(name.ToString(), writer_id, now,
                                                 [weak = std::weak_ptr<RecordingSession>(session)](
                                                     const absl::Status& reason) {
                                                   if (const auto evicted = weak.lock()) {
                                                     evicted->End(reason);
                                                   }
                                                 }));
  HOMING_RETURN_IF_ERROR(session->Start(std::move(claim)));
  return session;
}

RecordingSession::~RecordingSession() {
  if (claim_.journey) claim_.journey->EndStream(claim_.claim);
}

absl::Status RecordingSession::Start(WriterClaim claim) {
  claim_ = std::move(claim);
  HOMING_ASSIGN_OR_RETURN(const JourneyTail tail, claim_.journey->LoadTail());
  const storage::JourneyRecord record = claim_.journey->record();
  recorder_.emplace(record.settings, context_.limits);
  recorder_->Resume(tail);
  kind_ = record.input;
  next_ = record.next_sequence;
  expected_ = std::min(record.resend_from, next_);
  RecordingAnswer first;
  if (tail.last_sequence >= 0) first.frame = tail.last_sequence;
  const MutexLock lock(mutex_);
  durable_next_ = next_;
  durable_resend_from_ = expected_;
  Deliver({true, absl::OkStatus(), std::move(first)});
  return absl::OkStatus();
}

void RecordingSession::Record(const Observation& observation, TimePoint now) {
  if (ended()) {
    return;
  }
  const std::int64_t slot = OpenSlot();
  if (const absl::Status status = Process(observation, now, slot); !status.ok()) {
    Complete(slot, status, {});
  }
}

void RecordingSession::Reject(const absl::Status& status) { Complete(OpenSlot(), status, {}); }

// Checks the sequence, makes the step and submits it; the commit sends the answer.
absl::Status RecordingSession::Process(const Observation& observation, TimePoint now,
                                       std::int64_t slot) {
  HOMING_RETURN_IF_ERROR(claim_.journey->Renew(claim_.claim, now));
  HOMING_RETURN_IF_ERROR(CheckExpected(observation));
  const std::int64_t sequence = observation.sequence;
  RecordingAnswer answer;
  answer.sequence = sequence;
  answer.frame = observation.frame.value_or(sequence);
  if (sequence < expected_) {
    Complete(slot, absl::OkStatus(), std::move(answer));
    return absl::OkStatus();
  }
  HOMING_RETURN_IF_ERROR(CheckKind(observation));
  const auto sizes = ImageSizes(recorder_->settings());
  auto step = recorder_->Record(observation);
  if (!step.ok()) {
    return Within("observation", step.status());
  }
  HOMING_RETURN_IF_ERROR(TakeImageMemory());
  // Of the durable observations, tracking needs the reference only.
  expected_ = std::max(sequence + 1, next_);
  if (sequence < next_) {
    Complete(slot, absl::OkStatus(), std::move(answer));
    return absl::OkStatus();
  }
  next_ = sequence + 1;
  answer.is_standing = !*step && sequence > 0 && !observation.break_before;
  storage::JourneyAppend append{claim_.journey->name(),      sequence,         kind_,
                                observation.capture_time_ns, *std::move(step), std::nullopt,
                                recorder_->resend_from(),    claim_.epoch};
  if (ImageSizes(recorder_->settings()) != sizes) {
    append.settings = recorder_->settings();
  }
  return Commit(std::move(append), std::move(answer), slot);
}

absl::Status RecordingSession::CheckExpected(const Observation& observation) const {
  HOMING_RETURN_IF_ERROR(CheckSequenceNumber(observation.sequence));
  const bool resumes_after_break = observation.break_before && observation.sequence == next_;
  if (observation.sequence > expected_ && !resumes_after_break) {
    return SequenceGapError(observation.sequence, expected_);
  }
  return absl::OkStatus();
}

absl::Status RecordingSession::CheckKind(const Observation& observation) {
  const absl::StatusOr<InputKind> kind = InputKindOf(observation);
  if (!kind.ok()) return Within("observation", kind.status());
  if (kind_ != InputKind::kUnknown && *kind != kind_) {
    return WithReason(absl::FailedPreconditionError(
                          absl::StrCat("observation: ", NameOf(*kind), " must be ", NameOf(kind_),
                                       ", as the journey is recorded with ", NameOf(kind_))),
                      {"OTHER_INPUT", {}});
  }
  kind_ = *kind;
  return absl::OkStatus();
}

absl::Status RecordingSession::TakeImageMemory() {
  if (kind_ != InputKind::kFrames) return absl::OkStatus();
  const auto& [left, right] = recorder_->settings().cameras;
  const std::int64_t bytes = ImageBytes({left.width, right.width}, {left.height, right.height},
                                        recorder_->settings().flow);
  if (image_memory_.TrySet(bytes)) return absl::OkStatus();
  return WithReason(absl::ResourceExhaustedError(absl::StrCat(
                        "recording such images needs ", bytes,
                        " bytes; together with the other streams this is more than memory-quota, ",
                        context_.catalog->beliefs()->most(), " bytes")),
                    {"IMAGE_MEMORY", {}});
}

absl::Status RecordingSession::Commit(storage::JourneyAppend append, RecordingAnswer answer,
                                      std::int64_t slot) {
  HOMING_RETURN_IF_ERROR(claim_.journey->BeginAppend(claim_.claim));
  auto done = [self = shared_from_this(), slot, answer = std::move(answer)](
                  storage::JourneyAppend ended, const absl::Status& status) mutable {
    self->claim_.journey->EndAppend(ended, status);
    answer.resend_from = ended.resend_from;
    answer.step = std::move(ended.step);
    self->Complete(slot, status, std::move(answer));
  };
  absl::Status status = context_.queue->Submit(std::move(append), std::move(done));
  if (!status.ok()) {
    claim_.journey->EndAppend({}, status);
  }
  return status;
}

std::int64_t RecordingSession::OpenSlot() {
  const MutexLock lock(mutex_);
  slots_.emplace_back();
  return first_slot_ + static_cast<std::int64_t>(slots_.size()) - 1;
}

void RecordingSession::Complete(std::int64_t slot, const absl::Status& status,
                                RecordingAnswer answer) {
  const MutexLock lock(mutex_);
  if (ended_) {
    return;
  }
  slots_[static_cast<std::size_t>(slot - first_slot_)] = {true, status, std::move(answer)};
  while (!slots_.empty() && slots_.front().ready) {
    Slot ready = std::move(slots_.front());
    slots_.pop_front();
    ++first_slot_;
    Deliver(std::move(ready));
  }
}

void RecordingSession::Deliver(Slot slot) {
  if (ended_) {
    return;
  }
  if (!slot.status.ok()) {
    ended_ = true;
    listener_.end(slot.status);
    return;
  }
  if (slot.answer.sequence && *slot.answer.sequence >= durable_next_) {
    durable_next_ = *slot.answer.sequence + 1;
    durable_resend_from_ = slot.answer.resend_from;
  }
  slot.answer.next_sequence = durable_next_;
  slot.answer.resend_from = durable_resend_from_;
  listener_.answer(std::move(slot.answer));
}

bool RecordingSession::ended() {
  const MutexLock lock(mutex_);
  return ended_;
}

void RecordingSession::End(const absl::Status& status) {
  const MutexLock lock(mutex_);
  if (!ended_) {
    ended_ = true;
    listener_.end(status);
  }
}

}  // namespace homing::server
