#include "client/resend_buffer.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"

namespace homing::client {

ResendBuffer::ResendBuffer(ObservationStream* stream, int keep) : stream_(stream), keep_(keep) {}

std::int64_t ResendBuffer::end() const {
  return kept_.empty() ? next_ : kept_.back()->sequence() + 1;
}

std::size_t ResendBuffer::IndexOf(std::int64_t sequence) const {
  const auto found = std::lower_bound(
      kept_.begin(), kept_.end(), sequence,
      [](const auto& observation, std::int64_t value) { return observation->sequence() < value; });
  return static_cast<std::size_t>(found - kept_.begin());
}

bool ResendBuffer::Has(std::int64_t sequence) const {
  const std::size_t index = IndexOf(sequence);
  return index < kept_.size() && kept_[index]->sequence() == sequence;
}

absl::StatusOr<std::shared_ptr<const v1::Observation>> ResendBuffer::Next() {
  {
    const MutexLock lock(mutex_);
    if (cursor_ < kept_.size()) return kept_[cursor_++];
  }
  // Only this thread moves the cursor forward, so the stream may be read without the lock.
  HOMING_ASSIGN_OR_RETURN(auto next, stream_->Next());
  if (!next) return std::shared_ptr<const v1::Observation>();
  auto observation = std::make_shared<const v1::Observation>(*std::move(next));
  const MutexLock lock(mutex_);
  kept_.push_back(observation);
  cursor_ = kept_.size();
  next_ = observation->sequence() + 1;
  sent_ = std::max(sent_, next_);
  return observation;
}

void ResendBuffer::Drop(std::int64_t first, std::int64_t after, std::int64_t sequence) {
  // Keeps observations that still have to be sent again.
  const std::int64_t sent = cursor_ < kept_.size() ? kept_[cursor_]->sequence() : end();
  const auto erase = [this](std::int64_t from, std::int64_t to) HOMING_REQUIRES(mutex_) {
    const std::size_t begin = IndexOf(from);
    const std::size_t count = std::max(IndexOf(to), begin) - begin;
    const auto at = kept_.begin() + static_cast<std::ptrdiff_t>(begin);
    kept_.erase(at, at + static_cast<std::ptrdiff_t>(count));
    cursor_ -= count;
  };
  erase(after, std::min(sequence, sent));
  erase(0, std::min(first, sent));
}

void ResendBuffer::Acknowledge(std::int64_t sequence) {
  const MutexLock lock(mutex_);
  acknowledged_ = std::max(acknowledged_, sequence);
  sent_ = std::max(sent_, acknowledged_);
  Drop(acknowledged_ - keep_, acknowledged_, acknowledged_);
}

void ResendBuffer::Acknowledge(std::int64_t sequence, std::int64_t reference) {
  const MutexLock lock(mutex_);
  acknowledged_ = std::max(acknowledged_, sequence);
  sent_ = std::max(sent_, acknowledged_);
  Drop(reference - keep_, reference + 1, acknowledged_);
}

absl::Status ResendBuffer::Rewind(std::int64_t resend_from, std::int64_t durable) {
  const MutexLock lock(mutex_);
  const bool has_rest = Has(durable) || durable == end();
  if (has_rest && (Has(resend_from) || resend_from == end())) {
    cursor_ = IndexOf(resend_from);
    return absl::OkStatus();
  }
  if (stream_->Seek(resend_from)) {
    kept_.clear();
    cursor_ = 0;
    next_ = resend_from;
    return absl::OkStatus();
  }
  if (!has_rest && !kept_.empty()) {
    return absl::DataLossError(absl::StrCat(
        "the server needs observation ", durable, ", but the camera cannot go back and only ",
        kept_.front()->sequence(), " to ", end() - 1, " are kept"));
  }
  if (!Has(durable)) {
    kept_.clear();
    cursor_ = 0;
    next_ = durable;
    stream_->ContinueAt(durable);
    return absl::OkStatus();
  }
  cursor_ = IndexOf(durable);
  auto marked = std::make_shared<v1::Observation>(*kept_[cursor_]);
  marked->set_break_before(true);
  kept_[cursor_] = std::move(marked);
  return absl::OkStatus();
}

std::int64_t ResendBuffer::sent() const {
  const MutexLock lock(mutex_);
  return sent_;
}

std::int64_t ResendBuffer::RewindTo(std::int64_t sequence) {
  const MutexLock lock(mutex_);
  cursor_ = IndexOf(sequence);
  return cursor_ < kept_.size() ? kept_[cursor_]->sequence() : next_;
}

}  // namespace homing::client
