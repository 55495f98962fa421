// How a journey in memory follows a store that other servers write to.
#include <utility>

#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"
#include "server/catalog/journey_errors.h"
#include "server/catalog/live_journey.h"

namespace homing::server {

absl::Status LiveJourney::Follow(const storage::JourneyMark& mark) {
  const bool is_finished = mark.state == storage::JourneyState::kFinished;
  bool is_replaced = false;
  WriterLease::Evict evict;
  {
    const MutexLock lock(mutex_);
    // While a claim is being made here, the store may know its epoch before this object does.
    is_replaced = epoch_ != 0 && mark.epoch > epoch_ && !is_claiming_;
    // lease_ decides, not record_, which may have caught up without ending the claim.
    const bool is_over = is_finished && lease_.is_held();
    const bool is_behind = mark.next_sequence > record_.next_sequence && appends_under_way_ == 0;
    const bool is_same = mark.state == record_.state && mark.revision == revision_;
    if (!is_replaced && !is_over && !is_behind && is_same) {
      return absl::OkStatus();
    }
    if (is_replaced || is_over) {
      evict = lease_.Release();
      AwaitQuiet();
    }
  }
  if (evict) {
    evict(is_finished ? JourneyFinished(name_) : WriterReplaced(name_));
  }
  HOMING_RETURN_IF_ERROR(CatchUp());
  const MutexLock lock(mutex_);
  revision_ = mark.revision;
  if (is_replaced && epoch_ < mark.epoch) epoch_ = 0;
  return absl::OkStatus();
}

absl::Status LiveJourney::CatchUp() {
  while (true) {
    std::int64_t first = 0;
    bool with_steps = false;
    {
      const MutexLock lock(mutex_);
      with_steps = map_state_ != MapState::kNone;
      first = with_steps ? record_.step_count : kMostSteps;
    }
    HOMING_ASSIGN_OR_RETURN(storage::JourneyGrowth growth, store_->LoadSteps(name_, first));
    if (TakeGrowth(std::move(growth), with_steps)) break;
  }
  if (map_mutex_.TryLock()) {
    ApplyPending();
    map_mutex_.Unlock();
  }
  return absl::OkStatus();
}

bool LiveJourney::TakeGrowth(storage::JourneyGrowth growth, bool with_steps) {
  const MutexLock lock(mutex_);
  // Appends of this server may have been committed meanwhile.
  if (appends_under_way_ > 0 || growth.record.next_sequence < record_.next_sequence) {
    record_.readers = growth.record.readers;
    return true;
  }
  if (map_state_ != MapState::kNone) {
    if (!with_steps && growth.record.step_count > record_.step_count) return false;
    for (JourneyStep& step : growth.steps) {
      if (step.step >= record_.step_count) pending_.push_back(std::move(step));
    }
  }
  settings_changed_ = settings_changed_ || !(growth.record.settings == record_.settings);
  record_ = std::move(growth.record);
  return true;
}

}  // namespace homing::server
