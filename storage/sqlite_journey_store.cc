#include "storage/sqlite_journey_store.h"

#include "absl/strings/str_cat.h"
#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"
#include "storage/backup.h"
#include "storage/journey_rows.h"
#include "storage/map_rows.h"
#include "storage/model_rows.h"
#include "storage/schema.h"
#include "storage/sqlite_status.h"

namespace homing::storage {

absl::Status SqliteJourneyStore::StartCheckpoints(int busy_timeout_ms) {
  HOMING_ASSIGN_OR_RETURN(
      checkpointer_, Checkpointer::Start(path_, writer_.get(), &write_mutex_, busy_timeout_ms));
  return absl::OkStatus();
}

absl::Status SqliteJourneyStore::Transact(const Body& body) {
  if (read_only()) {
    return absl::FailedPreconditionError(
        "store: it is read-only (--readonly): nothing can be recorded, changed or deleted");
  }
  const MutexLock lock(write_mutex_);
  Connection& writer = *writer_;
  const int changes = writer.changes();
  absl::Status status = writer.Write([&] { return body(writer); });
  if (!status.ok()) appends_.Forget();
  NoteHealth(status, writer.changes() != changes);
  return status;
}

absl::Status SqliteJourneyStore::Write(const Body& body) {
  return Transact([&](Connection& connection) {
    appends_.Forget();
    return body(connection);
  });
}

void SqliteJourneyStore::NoteHealth(const absl::Status& written, bool changed) {
  const bool fault = IsStoreFault(written);
  if (!fault && !(written.ok() && changed)) return;
  const MutexLock lock(health_mutex_);
  write_health_ = fault ? written : absl::OkStatus();
}

absl::Status SqliteJourneyStore::WriteHealth() {
  const MutexLock lock(health_mutex_);
  return write_health_;
}

absl::Status SqliteJourneyStore::ProbeWrite() {
  if (!read_only()) {
    const MutexLock lock(write_mutex_);
    Connection& writer = *writer_;
    NoteHealth(writer.Write([&] { return TouchSchemaVersion(writer); }), true);
  }
  return WriteHealth();
}

absl::Status SqliteJourneyStore::Read(const Body& body) {
  if (queries_) return queries_->Read(body);
  const MutexLock lock(write_mutex_);
  Connection& writer = *writer_;
  return writer.Read([&] { return body(writer); });
}

template <typename Result, typename Query>
absl::StatusOr<Result> SqliteJourneyStore::ReadOne(Query query) {
  absl::StatusOr<Result> result = absl::InternalError("store: nothing read");
  HOMING_RETURN_IF_ERROR(Read([&](Connection& connection) {
    result = query(connection);
    return result.status();
  }));
  return result;
}

absl::Status SqliteJourneyStore::CreateJourney(const JourneyRecord& record) {
  JourneyRecord empty = record;
  empty.step_count = 0;
  empty.landmark_count = 0;
  empty.fingerprint_count = 0;
  return Write([&](Connection& connection) { return InsertJourney(connection, empty).status(); });
}

absl::StatusOr<JourneyRecord> SqliteJourneyStore::GetJourney(const std::string& name) {
  return ReadOne<JourneyRecord>([&](Connection& connection) -> absl::StatusOr<JourneyRecord> {
    HOMING_ASSIGN_OR_RETURN(JourneyRow row, FindJourney(connection, name));
    return std::move(row.record);
  });
}

absl::StatusOr<std::vector<JourneyRecord>> SqliteJourneyStore::ListJourneys(
    const std::string& prefix, const std::string& after, int limit) {
  return ReadOne<std::vector<JourneyRecord>>(
      [&](Connection& connection) { return ListJourneyRows(connection, prefix, after, limit); });
}

absl::Status SqliteJourneyStore::DeleteJourney(const std::string& name) {
  return Write([&](Connection& connection) { return DeleteJourneyRow(connection, name); });
}

absl::Status SqliteJourneyStore::FinishJourney(const std::string& name) {
  return Write([&](Connection& connection) {
    return SetJourneyState(connection, name, JourneyState::kFinished);
  });
}

absl::Status SqliteJourneyStore::SetWriter(const std::string& name, const std::string& writer_id) {
  return Write(
      [&](Connection& connection) { return SetJourneyWriter(connection, name, writer_id); });
}

std::vector<absl::Status> SqliteJourneyStore::AppendSteps(
    const std::vector<JourneyAppend>& appends) {
  std::vector<absl::Status> statuses;
  statuses.reserve(appends.size());
  const absl::Status transaction = Transact([&](Connection&) {
    for (const JourneyAppend& append : appends) statuses.push_back(appends_.Append(append));
    appends_.Write();
    return absl::OkStatus();
  });
  if (!transaction.ok()) statuses.assign(appends.size(), transaction);
  return statuses;
}

absl::StatusOr<JourneyMap> SqliteJourneyStore::LoadMap(const std::string& name) {
  return ReadOne<JourneyMap>([&](Connection& connection) -> absl::StatusOr<JourneyMap> {
    HOMING_ASSIGN_OR_RETURN(JourneyRow row, FindJourney(connection, name));
    return ReadMap(connection, row);
  });
}

absl::StatusOr<JourneyTail> SqliteJourneyStore::LoadTail(const std::string& name) {
  return ReadOne<JourneyTail>([&](Connection& connection) -> absl::StatusOr<JourneyTail> {
    HOMING_ASSIGN_OR_RETURN(JourneyRow row, FindJourney(connection, name));
    return ReadTail(connection, row);
  });
}

absl::Status SqliteJourneyStore::ImportJourney(const JourneyRecord& record, const JourneyMap& map) {
  HOMING_RETURN_IF_ERROR(Validate(record.settings));
  JourneyRecord finished = record;
  finished.state = JourneyState::kFinished;
  finished.step_count = map.step_count();
  finished.landmark_count = static_cast<std::int32_t>(map.landmarks().size());
  finished.fingerprint_count = static_cast<std::int64_t>(map.all_fingerprints().size());
  return Write([&](Connection& connection) -> absl::Status {
    HOMING_ASSIGN_OR_RETURN(std::int64_t id, InsertJourney(connection, finished));
    WriteMap(connection, id, map);
    return absl::OkStatus();
  });
}

absl::StatusOr<std::unique_ptr<std::istream>> SqliteJourneyStore::BackUp() {
  if (!queries_ || read_only()) {
    return absl::FailedPreconditionError(
        absl::StrCat("store: '", path_, "' is ",
                     read_only() ? "read-only: its file itself may be copied"
                                 : "in memory and cannot be copied"));
  }
  if (backing_up_.exchange(true)) {
    return absl::AbortedError("store: another copy is being made; try again when it is done");
  }
  absl::StatusOr<std::unique_ptr<std::istream>> copy = CopyForReading(path_, path_ + "-backup");
  backing_up_ = false;
  return copy;
}

absl::Status SqliteJourneyStore::CreateModel(const StoredModel& model) {
  return Write([&](Connection& connection) { return InsertModel(connection, model); });
}

absl::StatusOr<StoredModel> SqliteJourneyStore::GetModel(const std::string& name) {
  return ReadOne<StoredModel>([&](Connection& connection) { return FindModel(connection, name); });
}

absl::StatusOr<std::vector<StoredModel>> SqliteJourneyStore::ListModels(const std::string& after,
                                                                        int limit) {
  return ReadOne<std::vector<StoredModel>>(
      [&](Connection& connection) { return ListModelRows(connection, after, limit); });
}

}  // namespace homing::storage
