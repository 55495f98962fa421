#include "storage/sqlite_journey_store.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"
#include "storage/backup.h"
#include "storage/journey_rows.h"
#include "storage/map_assembly.h"
#include "storage/map_rows.h"
#include "storage/model_rows.h"
#include "storage/schema.h"
#include "storage/sqlite_status.h"
#include "storage/store_errors.h"

namespace homing::storage {
namespace {

// Bytes of the header of SQLite's log, and of the header of each page in it.
constexpr std::int64_t kLogHeaderBytes = 32;
constexpr std::int64_t kLogFrameBytes = 24;
// As journal_size_limit: SQLite truncates a longer log.
constexpr std::int64_t kLogKeptBytes = 67'108'864;
// Least time between two checks of a damaged file.
constexpr std::chrono::seconds kCheckEvery{10};

}  // namespace

absl::Status SqliteJourneyStore::StartCheckpoints(int busy_timeout_ms) {
  HOMING_ASSIGN_OR_RETURN(
      checkpointer_, Checkpointer::Start(path_, writer_.get(), &write_mutex_, busy_timeout_ms));
  {
    const MutexLock lock(write_mutex_);
    Connection& writer = *writer_;
    HOMING_RETURN_IF_ERROR(writer.Run([&] {
      page_bytes_ = writer.Integer("PRAGMA page_size");
      return absl::OkStatus();
    }));
  }
  files_ = std::make_unique<FileIdentity>(path_);
  return absl::OkStatus();
}

absl::Status SqliteJourneyStore::Transact(const Body& body) {
  if (read_only()) return ReadOnlyError();
  const MutexLock lock(write_mutex_);
  HOMING_RETURN_IF_ERROR(CheckFiles());
  Connection& writer = *writer_;
  const int changes = writer.changes();
  absl::Status status = writer.Write([&] { return body(writer); });
  if (!status.ok()) appends_.Forget();
  NoteHealth(status, writer.changes() != changes);
  if (!status.ok() || files_ == nullptr) return status;
  NoteLogPages(checkpointer_->pages_in_log());
  // A write into a file that was removed or replaced is not stored.
  status = CheckFiles();
  if (!status.ok()) appends_.Forget();
  return status;
}

void SqliteJourneyStore::NoteLogPages(int pages) {
  const std::int64_t bytes = kLogHeaderBytes + pages * (page_bytes_ + kLogFrameBytes);
  files_->SetLogBytes(pages == 0 ? 0 : std::min(bytes, kLogKeptBytes));
}

absl::Status SqliteJourneyStore::CheckFiles() {
  if (files_ == nullptr) return absl::OkStatus();
  absl::Status status = files_->Check();
  if (status.ok() || !files_->IsLogCut()) return status;
  // A tool of SQLite that reads the file may have moved the log into it.
  if (const int pages = checkpointer_->CountPagesInLog(); pages >= 0) NoteLogPages(pages);
  return files_->Check();
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
  // A successful write to one part of the file does not prove that a damaged part is whole.
  if (!fault && absl::IsDataLoss(write_health_)) return;
  write_health_ = fault ? written : absl::OkStatus();
}

absl::Status SqliteJourneyStore::WriteHealth() {
  HOMING_RETURN_IF_ERROR(CheckFiles());
  {
    const MutexLock lock(health_mutex_);
    if (!write_health_.ok()) return write_health_;
  }
  TryFillReserve();
  return absl::OkStatus();
}

bool SqliteJourneyStore::IsHealed() {
  const auto begin = std::chrono::steady_clock::now();
  if (begin < next_check_) return false;
  bool good = false;
  const auto connection = OpenForReading(path_, kBusyTimeoutMs);
  const absl::Status status = !connection.ok() ? connection.status() : (*connection)->Run([&] {
    good = (*connection)->Text("PRAGMA quick_check(1)") == "ok";
    return absl::OkStatus();
  });
  const auto end = std::chrono::steady_clock::now();
  next_check_ =
      end + std::max<std::chrono::steady_clock::duration>(kCheckEvery, 10 * (end - begin));
  return good && status.ok();
}

absl::Status SqliteJourneyStore::ProbeWrite() {
  HOMING_RETURN_IF_ERROR(CheckFiles());
  if (absl::Status health = WriteHealth(); absl::IsDataLoss(health)) {
    if (!IsHealed()) return health;
    const MutexLock lock(health_mutex_);
    write_health_ = absl::OkStatus();
  }
  if (!read_only()) {
    const MutexLock lock(write_mutex_);
    Connection& writer = *writer_;
    NoteHealth(writer.Write([&] { return TouchSchemaVersion(writer); }), true);
  }
  return WriteHealth();
}

absl::Status SqliteJourneyStore::Read(const Body& body) {
  HOMING_RETURN_IF_ERROR(CheckFiles());
  if (queries_) {
    absl::Status status = queries_->Read(body);
    if (IsStoreFault(status) && absl::IsDataLoss(status)) NoteHealth(status, false);
    return status;
  }
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
  return Write([&](Connection& connection) {
    return InsertJourney(connection, EmptyRecord(record)).status();
  });
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

absl::Status SqliteJourneyStore::FinishJourney(const std::string& name) {
  return Write([&](Connection& connection) {
    return SetJourneyState(connection, name, JourneyState::kFinished);
  });
}

absl::StatusOr<AcquiredJourney> SqliteJourneyStore::AcquireJourney(const std::string& name,
                                                                   const std::string& writer_id) {
  AcquiredJourney acquired;
  const absl::Status status = Transact([&](Connection& connection) -> absl::Status {
    HOMING_ASSIGN_OR_RETURN(JourneyRow row, FindJourney(connection, name));
    if (row.record.state == JourneyState::kFinished) return JourneyIsFinished(name);
    if (row.record.writer_id != writer_id) {
      HOMING_RETURN_IF_ERROR(SetJourneyWriter(connection, name, writer_id));
      row.record.writer_id = writer_id;
    }
    acquired = {appends_.Acquire(name), std::move(row.record)};
    return absl::OkStatus();
  });
  HOMING_RETURN_IF_ERROR(status);
  return acquired;
}

absl::Status SqliteJourneyStore::SetReaders(const std::string& name,
                                            const std::vector<std::string>& readers) {
  return Write(
      [&](Connection& connection) { return SetJourneyReaders(connection, name, readers); });
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

absl::StatusOr<JourneyGrowth> SqliteJourneyStore::LoadSteps(const std::string& name,
                                                            std::int64_t first) {
  return ReadOne<JourneyGrowth>([&](Connection& connection) -> absl::StatusOr<JourneyGrowth> {
    HOMING_ASSIGN_OR_RETURN(JourneyRow row, FindJourney(connection, name));
    HOMING_ASSIGN_OR_RETURN(std::vector<JourneyStep> steps, ReadSteps(connection, row, first));
    return JourneyGrowth{std::move(row.record), std::move(steps)};
  });
}

absl::StatusOr<std::vector<JourneyMark>> SqliteJourneyStore::LoadMarks(
    const std::vector<std::string>& names) {
  std::vector<JourneyMark> marks;
  for (const std::string& name : names) {
    const absl::StatusOr<JourneyRecord> record = GetJourney(name);
    if (absl::IsNotFound(record.status())) continue;
    HOMING_RETURN_IF_ERROR(record.status());
    const MutexLock lock(write_mutex_);
    marks.push_back({name, record->create_time_ns, record->state, record->next_sequence,
                     appends_.epoch(name), 0});
  }
  return marks;
}

absl::StatusOr<JourneyTail> SqliteJourneyStore::LoadTail(const std::string& name) {
  return ReadOne<JourneyTail>([&](Connection& connection) -> absl::StatusOr<JourneyTail> {
    HOMING_ASSIGN_OR_RETURN(JourneyRow row, FindJourney(connection, name));
    return ReadTail(connection, row);
  });
}

absl::Status SqliteJourneyStore::ImportJourney(const JourneyRecord& record, const JourneyMap& map) {
  HOMING_RETURN_IF_ERROR(Validate(record.settings));
  const JourneyRecord finished = FinishedRecord(record, map);
  return Write([&](Connection& connection) -> absl::Status {
    HOMING_ASSIGN_OR_RETURN(std::int64_t id, InsertJourney(connection, finished));
    WriteMap(connection, id, map);
    return absl::OkStatus();
  });
}

absl::StatusOr<std::unique_ptr<std::istream>> SqliteJourneyStore::BackUp() {
  if (!queries_ || read_only()) {
    return absl::FailedPreconditionError(absl::StrCat(
        "store: '", path_, "' is ",
        read_only() ? "read-only: copy the file itself" : "in memory and cannot be copied"));
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
