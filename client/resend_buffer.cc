#include "client/resend_buffer.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"

namespace homing::client {

ResendBuffer::ResendBuffer(ObservationStream* stream, int keep) : stream_(stream), keep_(keep) {}

std::int64_t ResendBuffer::begin() const {
  return kept_.empty() ? cursor_ : kept_.front()->sequence();
}

std::int64_t ResendBuffer::end() const {
  return kept_.empty() ? cursor_ : kept_.back()->sequence() + 1;
}

absl::StatusOr<std::shared_ptr<const v1::Observation>> ResendBuffer::Next() {
  {
    const MutexLock lock(mutex_);
    if (cursor_ < end()) return kept_[static_cast<std::size_t>(cursor_++ - begin())];
  }
  // Only this thread moves the cursor, so the stream may be read without the lock.
  HOMING_ASSIGN_OR_RETURN(auto next, stream_->Next());
  if (!next) return std::shared_ptr<const v1::Observation>();
  auto observation = std::make_shared<const v1::Observation>(*std::move(next));
  const MutexLock lock(mutex_);
  kept_.push_back(observation);
  cursor_ = observation->sequence() + 1;
  return observation;
}

void ResendBuffer::Acknowledge(std::int64_t sequence) {
  const MutexLock lock(mutex_);
  acknowledged_ = std::max(acknowledged_, sequence);
  // Entries before the cursor that are old enough are dropped.
  const std::int64_t first = std::min(acknowledged_ - keep_, cursor_);
  while (!kept_.empty() && kept_.front()->sequence() < first) kept_.pop_front();
}

absl::Status ResendBuffer::Rewind(std::int64_t resend_from, std::int64_t durable) {
  const MutexLock lock(mutex_);
  if (begin() <= resend_from && resend_from <= end()) {
    cursor_ = resend_from;
    return absl::OkStatus();
  }
  if (stream_->Seek(resend_from)) {
    kept_.clear();
    cursor_ = resend_from;
    return absl::OkStatus();
  }
  if (kept_.empty()) {
    stream_->ContinueAt(durable);
    cursor_ = durable;
    return absl::OkStatus();
  }
  if (durable < begin() || durable > end()) {
    return absl::DataLossError(absl::StrCat("the server needs observation ", durable,
                                            ", but the camera cannot go back and only ", begin(),
                                            " to ", end() - 1, " are kept"));
  }
  cursor_ = durable;
  if (durable == end()) {
    kept_.clear();
    stream_->ContinueAt(durable);
    return absl::OkStatus();
  }
  auto& first = kept_[static_cast<std::size_t>(durable - begin())];
  auto marked = std::make_shared<v1::Observation>(*first);
  marked->set_break_before(true);
  first = std::move(marked);
  return absl::OkStatus();
}

std::int64_t ResendBuffer::RewindAll() {
  const MutexLock lock(mutex_);
  cursor_ = begin();
  return cursor_;
}

}  // namespace homing::client
