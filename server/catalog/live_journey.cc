#include "server/catalog/live_journey.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"
#include "server/catalog/fleet_index.h"
#include "server/catalog/journey_errors.h"
#include "storage/growing_journey.h"

namespace homing::server {

LiveJourney::LiveJourney(storage::JourneyRecord record, storage::JourneyStore* store,
                         FleetIndex* index)
    : name_(record.name), store_(store), index_(index), record_(std::move(record)) {}

storage::JourneyRecord LiveJourney::record() const {
  const MutexLock lock(mutex_);
  return record_;
}

bool LiveJourney::deleted() const {
  const MutexLock lock(mutex_);
  return deleted_;
}

std::int64_t LiveJourney::MemoryBytes() const {
  constexpr std::int64_t kBytesAJourney = 2048;
  const MutexLock lock(mutex_);
  if (map_state_ == MapState::kNone) return kBytesAJourney;
  const auto steps = static_cast<std::int64_t>(2 * sizeof(std::int64_t) + 2 * sizeof(FlowProfile));
  return kBytesAJourney + record_.step_count * steps +
         record_.landmark_count * static_cast<std::int64_t>(sizeof(Landmark)) +
         record_.fingerprint_count * static_cast<std::int64_t>(sizeof(Fingerprint));
}

bool LiveJourney::IsIdle(TimePoint now) const {
  const MutexLock lock(mutex_);
  return appends_under_way_ == 0 && lease_.CheckFree("", now).ok();
}

absl::Status LiveJourney::CheckPresent() const {
  return deleted_ ? absl::NotFoundError(absl::StrCat("journey: \"", name_, "\" was deleted"))
                  : absl::OkStatus();
}

absl::Status LiveJourney::CheckWritable() const {
  HOMING_RETURN_IF_ERROR(CheckPresent());
  if (record_.state == storage::JourneyState::kFinished) {
    return JourneyFinished(name_);
  }
  return absl::OkStatus();
}

void LiveJourney::AwaitQuiet() {
  while (appends_under_way_ > 0) quiet_.Wait(mutex_);
}

absl::StatusOr<LiveClaim> LiveJourney::Claim(const std::string& writer_id, TimePoint now,
                                             WriterLease::Evict evict) {
  WriterLease::Evict previous;
  LiveClaim claim;
  {
    const MutexLock lock(mutex_);
    HOMING_RETURN_IF_ERROR(CheckWritable());
    HOMING_RETURN_IF_ERROR(lease_.CheckFree(writer_id, now));
    claim.number = lease_.Take(writer_id, now, std::move(evict), &previous);
    AwaitQuiet();
    is_claiming_ = true;
  }
  if (previous) {
    previous(WriterReplaced(name_));
  }
  const auto acquired = store_->AcquireJourney(name_, writer_id);
  bool is_behind = false;
  {
    const MutexLock lock(mutex_);
    is_claiming_ = false;
    if (!acquired.ok()) {
      lease_.Release();
      return acquired.status();
    }
    claim.epoch = epoch_ = acquired->epoch;
    record_.writer_id = writer_id;
    is_behind = acquired->record.next_sequence != record_.next_sequence ||
                !(acquired->record.settings == record_.settings);
  }
  if (is_behind) {
    HOMING_RETURN_IF_ERROR(CatchUp());
  }
  return claim;
}

absl::Status LiveJourney::CheckClaim(const std::string& writer_id, TimePoint now) const {
  const MutexLock lock(mutex_);
  HOMING_RETURN_IF_ERROR(CheckWritable());
  return lease_.CheckFree(writer_id, now);
}

absl::Status LiveJourney::Renew(std::uint64_t claim, TimePoint now) {
  const MutexLock lock(mutex_);
  if (!lease_.Holds(claim)) {
    return WriterReplaced(name_);
  }
  lease_.Renew(now);
  return absl::OkStatus();
}

absl::Status LiveJourney::BeginAppend(std::uint64_t claim) {
  const MutexLock lock(mutex_);
  if (!lease_.Holds(claim)) {
    return WriterReplaced(name_);
  }
  ++appends_under_way_;
  return absl::OkStatus();
}

void LiveJourney::EndAppend(const storage::JourneyAppend& append, const absl::Status& status) {
  std::optional<JourneySettings> indexed;
  {
    const MutexLock lock(mutex_);
    if (status.ok()) {
      storage::GrowRecord(record_, append);
      settings_changed_ = settings_changed_ || append.settings.has_value();
      if (append.step) {
        if (map_state_ != MapState::kNone) pending_.push_back(*append.step);
        if (index_ != nullptr) indexed = record_.settings;
      }
    }
  }
  if (indexed) {
    index_->Appended(name_, *indexed, *append.step);
  }
  {
    // Last, because Delete waits for it and then reports the deletion to the index.
    const MutexLock lock(mutex_);
    --appends_under_way_;
  }
  quiet_.NotifyAll();
  if (map_mutex_.TryLock()) {
    ApplyPending();
    map_mutex_.Unlock();
  }
}

void LiveJourney::EvictWriter(const absl::Status& reason) {
  WriterLease::Evict evict;
  {
    const MutexLock lock(mutex_);
    evict = lease_.Release();
    AwaitQuiet();
  }
  if (evict) {
    evict(reason);
  }
}

absl::Status LiveJourney::CheckWriter(const std::string& writer_id, TimePoint now) const {
  const MutexLock lock(mutex_);
  return lease_.CheckFree(writer_id, now);
}

absl::Status LiveJourney::CheckNoStream(TimePoint now) const {
  const MutexLock lock(mutex_);
  return lease_.CheckNoStream(now);
}

void LiveJourney::EndStream(std::uint64_t claim) {
  const MutexLock lock(mutex_);
  lease_.EndStream(claim);
}

void LiveJourney::SetReaders(const std::vector<std::string>& readers) {
  const MutexLock lock(mutex_);
  record_.readers = readers;
}

void LiveJourney::MarkFinished() {
  const MutexLock lock(mutex_);
  record_.state = storage::JourneyState::kFinished;
}

void LiveJourney::MarkDeleted() {
  const MutexLock lock(mutex_);
  deleted_ = true;
}

void LiveJourney::ApplyPending() {
  std::vector<JourneyStep> steps;
  {
    const MutexLock lock(mutex_);
    if (map_state_ != MapState::kLoaded) return;
    steps.swap(pending_);
    if (std::exchange(settings_changed_, false)) {
      map_.mutable_settings() = record_.settings;
    }
  }
  for (const JourneyStep& step : steps) {
    // The loaded map may already hold the step.
    if (step.step < map_.step_count()) continue;
    // The store accepted the same step by the same rules: Append cannot fail here.
    map_.Append(step).IgnoreError();
  }
}

absl::Status LiveJourney::LoadMap() {
  const MutexLock load_lock(load_mutex_);
  {
    const MutexLock lock(mutex_);
    if (map_state_ == MapState::kLoaded) return absl::OkStatus();
    map_state_ = MapState::kLoading;
  }
  absl::StatusOr<JourneyMap> map = store_->LoadMap(name_);
  const MutexLock map_lock(map_mutex_);
  const MutexLock lock(mutex_);
  // A new journey of the same name may have been created and its map loaded instead.
  absl::Status status = deleted_ ? CheckPresent() : map.status();
  if (!status.ok()) {
    map_state_ = MapState::kNone;
    pending_ = {};
    return status;
  }
  map_ = *std::move(map);
  map_state_ = MapState::kLoaded;
  return absl::OkStatus();
}

bool LiveJourney::has_map() const {
  const MutexLock lock(mutex_);
  return map_state_ == MapState::kLoaded;
}

void LiveJourney::LockMap() {
  bool behind = false;
  {
    const MutexLock lock(mutex_);
    behind = !pending_.empty() || settings_changed_;
  }
  if (behind) {
    map_mutex_.Lock();
    ApplyPending();
    map_mutex_.Unlock();
  }
  map_mutex_.LockShared();
}

MapsLock::MapsLock(const LiveJourneys& journeys) HOMING_UNCHECKED_LOCKS : journeys_(journeys) {
  for (const std::shared_ptr<LiveJourney>& journey : journeys_) {
    journey->LockMap();
  }
}

std::vector<JourneyRef> MapsLock::refs() const {
  std::vector<JourneyRef> refs;
  refs.reserve(journeys_.size());
  for (const std::shared_ptr<LiveJourney>& journey : journeys_) {
    refs.push_back({&journey->name(), &journey->map()});
  }
  return refs;
}

MapsLock::~MapsLock() HOMING_UNCHECKED_LOCKS {
  for (const std::shared_ptr<LiveJourney>& journey : journeys_) {
    journey->UnlockMap();
  }
}

}  // namespace homing::server
