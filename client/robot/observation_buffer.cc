#include "client/robot/observation_buffer.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"

namespace homing::robot {
namespace {

std::int64_t SizeOf(const StoredObservation& observation) {
  return static_cast<std::int64_t>(observation.bytes.size());
}

bool HasFlow(const v1::Observation& observation) {
  return observation.left().has_flow_vectors() || observation.right().has_flow_vectors();
}

}  // namespace

absl::StatusOr<std::unique_ptr<ObservationBuffer>> ObservationBuffer::Create(
    const BufferOptions& options, std::optional<ObservationFile> file) {
  ObservationFile::Extent extent;
  if (file) {
    HOMING_ASSIGN_OR_RETURN(extent, file->Measure());
  }
  return std::unique_ptr<ObservationBuffer>(
      new ObservationBuffer(options, std::move(file), extent));
}

ObservationBuffer::ObservationBuffer(const BufferOptions& options,
                                     std::optional<ObservationFile> file,
                                     const ObservationFile::Extent& extent)
    : options_(options),
      file_(std::move(file)),
      file_bytes_(extent.bytes),
      file_end_(extent.end),
      end_(extent.end),
      opened_at_(extent.end),
      durable_(extent.end - extent.count),
      cursor_(durable_) {}

ObservationBuffer::~ObservationBuffer() {
  const MutexLock lock(mutex_);
  if (!file_) return;
  if (pending_count() > 0) {
    WriteToFile().IgnoreError();
  } else {
    // Drops the reference: only this process could continue to track from it.
    file_->DropBefore(end_, end_).IgnoreError();
  }
}

absl::StatusOr<std::int64_t> ObservationBuffer::Add(v1::Observation observation) {
  const MutexLock lock(mutex_);
  if (closed_) return absl::FailedPreconditionError("the recording is closed");
  observation.set_sequence(end_);
  if (dropped_ && HasFlow(observation)) observation.set_break_before(true);
  StoredObservation stored{end_, observation.SerializeAsString()};
  const std::int64_t bytes = memory_bytes_ + file_bytes_ + SizeOf(stored);
  if (bytes > options_.max_bytes || pending_count() >= options_.max_observations) {
    dropped_ = true;
    return absl::ResourceExhaustedError(
        absl::StrCat("the buffer is full: ", pending_count(), " observations wait for the server"));
  }
  dropped_ = false;
  const std::int64_t size = SizeOf(stored);
  memory_bytes_ += size;
  memory_.push_back(std::move(stored));
  ++end_;
  if (file_ && pending_count() > options_.memory_observations) {
    if (absl::Status status = WriteToFile(); !status.ok()) {
      // What was refused must not be recorded: the caller may add it again.
      memory_.pop_back();
      memory_bytes_ -= size;
      --end_;
      dropped_ = true;
      return status;
    }
  }
  changed_.NotifyAll();
  return end_ - 1;
}

absl::Status ObservationBuffer::WriteToFile() {
  if (memory_.empty()) return absl::OkStatus();
  const std::vector<StoredObservation> all(memory_.begin(), memory_.end());
  HOMING_RETURN_IF_ERROR(file_->Append(all));
  file_bytes_ += std::exchange(memory_bytes_, 0);
  file_end_ = all.back().sequence + 1;
  memory_.clear();
  return absl::OkStatus();
}

void ObservationBuffer::Acknowledge(std::int64_t durable, std::int64_t reference) {
  const MutexLock lock(mutex_);
  if (durable <= durable_) return;
  durable_ = durable;
  std::int64_t from_memory = 0;
  std::erase_if(memory_, [&](const StoredObservation& observation) {
    const bool drop = observation.sequence < durable && observation.sequence != reference;
    if (drop) from_memory += SizeOf(observation);
    return drop;
  });
  memory_bytes_ -= from_memory;
  // While all observations are in memory, the file has nothing to drop.
  if (!file_ || file_bytes_ == 0) return;
  // On a full disk they stay until a later call: a new process passes over what the server has.
  const auto dropped = file_->DropBefore(durable, reference);
  if (dropped.ok()) file_bytes_ -= *dropped;
}

void ObservationBuffer::Close() {
  const MutexLock lock(mutex_);
  closed_ = true;
  changed_.NotifyAll();
}

void ObservationBuffer::Stop() {
  const MutexLock lock(mutex_);
  closed_ = stopped_ = true;
  changed_.NotifyAll();
}

std::int64_t ObservationBuffer::pending() const {
  const MutexLock lock(mutex_);
  return pending_count();
}

bool ObservationBuffer::Await() {
  const MutexLock lock(mutex_);
  while (!stopped_ && cursor_ >= end_) changed_.Wait(mutex_);
  return !stopped_;
}

absl::Status ObservationBuffer::Renumber(std::int64_t first, std::int64_t shift) {
  if (file_) HOMING_RETURN_IF_ERROR(file_->Renumber(first, shift));
  for (StoredObservation& observation : memory_) {
    if (observation.sequence >= first) observation.sequence += shift;
  }
  if (file_end_ > first) file_end_ += shift;
  end_ += shift;
  opened_at_ += shift;
  return absl::OkStatus();
}

absl::StatusOr<std::int64_t> ObservationBuffer::CloseGap(std::int64_t durable) {
  // The reference may stand alone before the others.
  HOMING_ASSIGN_OR_RETURN(const auto first, Find(std::max(durable, durable_)));
  if (!file_ || !first || first->sequence <= durable) return 0;
  v1::Observation marked;
  if (!marked.ParseFromString(first->bytes)) {
    return absl::DataLossError(absl::StrCat("observation ", first->sequence, " is damaged"));
  }
  // In the file: a later process may send it.
  marked.set_break_before(true);
  const StoredObservation again[] = {{first->sequence, marked.SerializeAsString()}};
  HOMING_RETURN_IF_ERROR(file_->Append(again));
  HOMING_RETURN_IF_ERROR(file_->DropBefore(first->sequence, first->sequence).status());
  HOMING_RETURN_IF_ERROR(Renumber(first->sequence, durable - first->sequence));
  HOMING_ASSIGN_OR_RETURN(const ObservationFile::Extent extent, file_->Measure());
  file_bytes_ = extent.bytes;
  return first->sequence - durable;
}

absl::StatusOr<std::int64_t> ObservationBuffer::Align(std::int64_t durable) {
  const MutexLock lock(mutex_);
  std::int64_t missing = 0;
  if (durable > opened_at_) {
    HOMING_RETURN_IF_ERROR(Renumber(opened_at_, durable - opened_at_));
  } else {
    HOMING_ASSIGN_OR_RETURN(missing, CloseGap(durable));
  }
  durable_ = std::clamp(durable, std::int64_t{0}, end_);
  cursor_ = durable_;
  // The camera may have moved since the previous process.
  if (opened_at_ > 0) breaks_.insert(opened_at_);
  return missing;
}

absl::StatusOr<std::optional<StoredObservation>> ObservationBuffer::Find(
    std::int64_t sequence) const {
  if (file_ && file_bytes_ > 0) {
    HOMING_ASSIGN_OR_RETURN(std::optional<StoredObservation> found, file_->Read(sequence));
    if (found) return found;
  }
  const auto found = std::find_if(
      memory_.begin(), memory_.end(),
      [&](const StoredObservation& observation) { return observation.sequence >= sequence; });
  if (found == memory_.end()) return std::nullopt;
  return *found;
}

absl::StatusOr<std::optional<v1::Observation>> ObservationBuffer::Next() {
  const MutexLock lock(mutex_);
  while (!stopped_ && !closed_ && cursor_ >= end_) changed_.Wait(mutex_);
  if (stopped_ || cursor_ >= end_) return std::nullopt;
  HOMING_ASSIGN_OR_RETURN(const std::optional<StoredObservation> found, Find(cursor_));
  v1::Observation observation;
  if (!found || !observation.ParseFromString(found->bytes)) {
    return absl::DataLossError(absl::StrCat("observation ", cursor_, " is not in the buffer"));
  }
  observation.set_sequence(found->sequence);
  if (breaks_.contains(found->sequence)) observation.set_break_before(true);
  cursor_ = found->sequence + 1;
  return observation;
}

bool ObservationBuffer::Seek(std::int64_t sequence) {
  const MutexLock lock(mutex_);
  if (sequence != end_) {
    const auto found = Find(sequence);
    if (!found.ok() || !*found || (**found).sequence != sequence) return false;
  }
  cursor_ = sequence;
  return true;
}

void ObservationBuffer::ContinueAt(std::int64_t sequence) {
  const MutexLock lock(mutex_);
  cursor_ = sequence;
  breaks_.insert(sequence);
}

}  // namespace homing::robot
