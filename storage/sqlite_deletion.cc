// Deleting from SQLite's store, also on a full disk.
#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"
#include "storage/journey_rows.h"
#include "storage/sqlite_journey_store.h"
#include "storage/sqlite_status.h"
#include "storage/step_id.h"
#include "storage/store_errors.h"

namespace homing::storage {
namespace {

// Steps in one transaction: its log takes about two megabytes, and other writers wait for some
// milliseconds.
constexpr std::int64_t kPiece = 4096;
constexpr std::int64_t kLeastPiece = 64;
// Upper bound of the log that a deleted step needs, with its part of the other changes.
constexpr std::int64_t kLogBytesAStep = 1024;

// A longer journey is renamed first (kHiddenPrefix), so that it disappears at once and whole, and
// its key is not used again while steps are left.
constexpr char kFindId[] = "SELECT journey_id FROM journeys WHERE name = ?";
constexpr char kCountSome[] =
    "SELECT count(*) FROM (SELECT 1 FROM steps WHERE step_id >= ? AND step_id < ? LIMIT ?)";
constexpr char kHide[] =
    "UPDATE journeys SET name = 'deleted/' || journey_id, step_count = 0, landmark_count = 0,"
    " fingerprint_count = 0 WHERE name = ?";
constexpr char kFindHidden[] =
    "SELECT journey_id FROM journeys WHERE name >= 'deleted/' AND name < 'deleted0' LIMIT 1";
constexpr char kDeletePiece[] =
    "DELETE FROM steps WHERE step_id IN"
    " (SELECT step_id FROM steps WHERE step_id >= ? AND step_id < ? ORDER BY step_id LIMIT ?)";
constexpr char kDeleteHidden[] = "DELETE FROM journeys WHERE journey_id = ?";

// Up to `most` steps of a hidden journey, or the journey. False: there is none.
bool DeletePiece(Connection& connection, std::int64_t most) {
  std::int64_t id = 0;
  {
    Query hidden = connection.Prepare(kFindHidden);
    if (!hidden.Next()) return false;
    id = hidden.Integer(0);
  }
  const int deleted =
      connection.Prepare(kDeletePiece, StepId(id, 0), StepId(id + 1, 0), most).Run();
  if (deleted == 0) connection.Prepare(kDeleteHidden, id).Run();
  return true;
}

// Deletes a journey of up to `most` steps, hides a longer one and deletes its first piece: nothing
// changes if not even that finds room.
absl::Status DeleteOrHide(Connection& connection, const std::string& name, std::int64_t most,
                          bool* is_hidden) {
  Query found = connection.Prepare(kFindId, name);
  if (!found.Next()) return JourneyNotFound(name);
  const std::int64_t id = found.Integer(0);
  Query steps = connection.Prepare(kCountSome, StepId(id, 0), StepId(id + 1, 0), most + 1);
  *is_hidden = steps.Next() && steps.Integer(0) > most;
  if (!*is_hidden) return DeleteJourneyRow(connection, name);
  connection.Prepare(kHide, name).Run();
  DeletePiece(connection, most);
  return absl::OkStatus();
}

}  // namespace

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
  bool is_hidden = false;
  absl::Status deleted = DeleteOnce(name, {kPiece, false}, &is_hidden);
  if (!absl::IsResourceExhausted(deleted)) {
    // Deletes the steps that an earlier deletion left because it found no room.
    FinishDeletions().IgnoreError();
    return deleted;
  }
  const MutexLock lock(reserve_mutex_);
  const std::int64_t bytes = reserve_ == nullptr ? 0 : reserve_->GiveUp();
  if (bytes == 0) return deleted;
  const Pieces pieces{std::clamp(bytes / kLogBytesAStep, kLeastPiece, kPiece), true};
  absl::Status again = DeleteOnce(name, pieces, &is_hidden);
  // Moves the log into the file. The log then restarts at its beginning, so that later writes need
  // no more space.
  checkpointer_->MoveNow();
  if (absl::IsResourceExhausted(again)) {
    again = DeleteOnce(name, pieces, &is_hidden);
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

absl::Status SqliteJourneyStore::DeleteOnce(const std::string& name, Pieces pieces,
                                            bool* is_hidden) {
  if (!*is_hidden) {
    absl::Status status = Write([&](Connection& connection) {
      appends_.ForgetEpoch(name);
      return DeleteOrHide(connection, name, pieces.steps, is_hidden);
    });
    if (!status.ok()) *is_hidden = false;
    if (!status.ok() || !*is_hidden) return status;
  }
  return DeleteHidden(pieces);
}

absl::Status SqliteJourneyStore::DeleteHidden(Pieces pieces) {
  bool is_more = true;
  while (is_more) {
    HOMING_RETURN_IF_ERROR(Transact([&](Connection& connection) {
      is_more = DeletePiece(connection, pieces.steps);
      return absl::OkStatus();
    }));
    if (pieces.reuse_log) checkpointer_->MoveNow();
  }
  return absl::OkStatus();
}

absl::Status SqliteJourneyStore::FinishDeletions() {
  if (read_only()) return absl::OkStatus();
  bool is_hidden = false;
  {
    const MutexLock lock(write_mutex_);
    Connection& writer = *writer_;
    HOMING_RETURN_IF_ERROR(writer.Read([&] {
      is_hidden = writer.Prepare(kFindHidden).Next();
      return absl::OkStatus();
    }));
  }
  return is_hidden ? DeleteHidden({kPiece, false}) : absl::OkStatus();
}

}  // namespace homing::storage
