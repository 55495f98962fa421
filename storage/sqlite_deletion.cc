// Deleting from SQLite's store, also on a full disk.
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/mutex.h"
#include "storage/journey_rows.h"
#include "storage/sqlite_journey_store.h"
#include "storage/sqlite_status.h"

namespace homing::storage {

void SqliteJourneyStore::KeepReserve(std::unique_ptr<SpaceReserve> reserve) {
  const MutexLock lock(reserve_mutex_);
  reserve_ = std::move(reserve);
  FillReserve();
}

void SqliteJourneyStore::FillReserve() {
  if (reserve_ == nullptr || reserve_->bytes() == SpaceReserve::kMostBytes) return;
  reserve_->Fill();
  LimitLog();
}

void SqliteJourneyStore::TryFillReserve() {
  if (!reserve_mutex_.TryLock()) return;
  FillReserve();
  reserve_mutex_.Unlock();
}

void SqliteJourneyStore::LimitLog() {
  if (const std::int64_t bytes = reserve_->bytes(); bytes > 0) {
    checkpointer_->LimitLog(bytes / page_bytes_);
  }
}

absl::Status SqliteJourneyStore::DeleteJourney(const std::string& name) {
  absl::Status deleted = DeleteOnce(name);
  if (!absl::IsResourceExhausted(deleted)) return deleted;
  const MutexLock lock(reserve_mutex_);
  const std::int64_t bytes = reserve_ == nullptr ? 0 : reserve_->GiveUp();
  if (bytes == 0) return deleted;
  absl::Status again = DeleteOnce(name);
  // Moves the log into the file. The log then restarts at its beginning, so that later writes need
  // no more space.
  checkpointer_->MoveNow();
  if (absl::IsResourceExhausted(again)) {
    again = DeleteOnce(name);
    checkpointer_->MoveNow();
  }
  reserve_->TakeBack(bytes);
  LimitLog();
  if (!absl::IsResourceExhausted(again)) return again;
  return StoreFault(absl::StatusCode::kResourceExhausted,
                    absl::StrCat("store: the disk is full, and the ", bytes,
                                 " bytes kept for deleting are not enough for '", name,
                                 "': delete a smaller journey first, or free some space on the "
                                 "server's disk"));
}

absl::Status SqliteJourneyStore::DeleteOnce(const std::string& name) {
  return Write([&](Connection& connection) {
    appends_.ForgetEpoch(name);
    return DeleteJourneyRow(connection, name);
  });
}

}  // namespace homing::storage
