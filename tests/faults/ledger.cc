#include "tests/faults/ledger.h"

#include <algorithm>

#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"
#include "storage/journey_store.h"

namespace homing::faults {

void Ledger::Created(const std::string& journey, bool frames) {
  const MutexLock lock(mutex_);
  entries_[journey].frames = frames;
}

void Ledger::Advanced(const std::string& journey, std::int64_t next_sequence) {
  const MutexLock lock(mutex_);
  std::int64_t& known = entries_[journey].next_sequence;
  known = std::max(known, next_sequence);
}

void Ledger::Finished(const std::string& journey) {
  const MutexLock lock(mutex_);
  entries_[journey].finished = true;
}

void Ledger::Deleted(const std::string& journey) {
  const MutexLock lock(mutex_);
  entries_.erase(journey);
}

std::map<std::string, Acknowledged> Ledger::entries() const {
  const MutexLock lock(mutex_);
  return entries_;
}

absl::StatusOr<LedgerCheck> CheckDatabase(const std::string& url,
                                          const std::map<std::string, Acknowledged>& entries) {
  storage::StoreOptions options;
  options.url = url;
  HOMING_ASSIGN_OR_RETURN(const auto store, storage::OpenJourneyStore(options));
  LedgerCheck check;
  for (const auto& [name, acknowledged] : entries) {
    const auto record = store->GetJourney(name);
    if (absl::IsNotFound(record.status())) {
      check.lost += 1 + acknowledged.next_sequence;
      continue;
    }
    HOMING_RETURN_IF_ERROR(record.status());
    check.lost += std::max<std::int64_t>(0, acknowledged.next_sequence - record->next_sequence);
    check.lost += acknowledged.finished && record->state != storage::JourneyState::kFinished;
    const std::int64_t steps =
        std::max<std::int64_t>(0, record->next_sequence - (acknowledged.frames ? 1 : 0));
    check.twice += std::max<std::int64_t>(0, record->step_count - steps);
    check.lost += std::max<std::int64_t>(0, steps - record->step_count);
  }
  return check;
}

}  // namespace homing::faults
