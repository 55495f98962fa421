#include "storage/postgres/postgres_journey_store.h"

#include <random>
#include <utility>

#include "homing/base/status_macros.h"
#include "storage/map_assembly.h"
#include "storage/postgres/pg_journey_rows.h"
#include "storage/postgres/pg_model_rows.h"
#include "storage/postgres/pg_schema.h"
#include "storage/postgres/pg_step_rows.h"
#include "storage/postgres_store.h"
#include "storage/store_errors.h"

namespace homing::storage {

absl::StatusOr<std::unique_ptr<JourneyStore>> OpenPostgresStore(const StoreOptions& options) {
  return postgres::PostgresJourneyStore::Open(options);
}

namespace postgres {
namespace {

constexpr int kReaders = 4;
constexpr std::chrono::milliseconds kOpenTime{15'000};
constexpr auto kOneStatement = PgWriter::Scope::kOneStatement;
constexpr auto kTransaction = PgWriter::Scope::kTransaction;

std::int64_t NewServerId() {
  std::random_device random;
  return static_cast<std::int64_t>((std::uint64_t{random()} << 31U) ^ random());
}

}  // namespace

PostgresJourneyStore::PostgresJourneyStore(const std::string& url, PgConnection::Access access)
    : database_(url, access),
      server_id_(NewServerId()),
      readers_(&database_, kReaders),
      writer_(&database_) {}

absl::StatusOr<std::unique_ptr<PostgresJourneyStore>> PostgresJourneyStore::Open(
    const StoreOptions& options) {
  const auto access =
      options.read_only ? PgConnection::Access::kReadOnly : PgConnection::Access::kReadWrite;
  std::unique_ptr<PostgresJourneyStore> store(new PostgresJourneyStore(options.url, access));
  HOMING_RETURN_IF_ERROR(store->Prepare());
  return store;
}

absl::Status PostgresJourneyStore::Prepare() {
  const Deadline deadline = After(kOpenTime);
  HOMING_ASSIGN_OR_RETURN(const auto connection, database_.Connect(deadline));
  if (read_only()) return CheckSchema(*connection, deadline);
  HOMING_RETURN_IF_ERROR(Migrate(*connection, deadline));
  HOMING_ASSIGN_OR_RETURN(heartbeat_, Heartbeat::Start(&database_, server_id_));
  return absl::OkStatus();
}

absl::Status PostgresJourneyStore::WriteHealth() {
  return heartbeat_ ? heartbeat_->health() : absl::OkStatus();
}

absl::Status PostgresJourneyStore::ProbeWrite() {
  return heartbeat_ ? heartbeat_->Beat() : absl::OkStatus();
}

absl::Status PostgresJourneyStore::Write(PgWriter::Scope scope, const Body& body) {
  if (read_only()) return ReadOnlyError();
  absl::Status status = writer_.Write(scope, body);
  heartbeat_->NoteWrite(status);
  return status;
}

template <typename Result, typename Query>
absl::StatusOr<Result> PostgresJourneyStore::Read(PgWriter::Scope scope, Query query) {
  absl::StatusOr<Result> result = absl::InternalError("store: nothing read");
  const Body body = [&](PgConnection& connection, Deadline deadline) {
    result = query(connection, deadline);
    return result.status();
  };
  HOMING_RETURN_IF_ERROR(scope == kOneStatement ? readers_.ReadOnce(body) : readers_.Read(body));
  return result;
}

absl::Status PostgresJourneyStore::CreateJourney(const JourneyRecord& record) {
  const JourneyRecord empty = EmptyRecord(record);
  bool is_repeated = false;
  writer_.Forget(record.name);
  return Write(kOneStatement, [&](PgConnection& connection, Deadline deadline) {
    absl::Status status = InsertJourney(connection, empty, deadline);
    if (!std::exchange(is_repeated, true) || !absl::IsAlreadyExists(status)) return status;
    // The first try may have stored it.
    const auto stored = FindJourney(connection, record.name, deadline);
    const bool is_ours = stored.ok() && stored->create_time_ns == record.create_time_ns &&
                         stored->writer_id == record.writer_id;
    return is_ours ? absl::OkStatus() : status;
  });
}

absl::StatusOr<JourneyRecord> PostgresJourneyStore::GetJourney(const std::string& name) {
  return Read<JourneyRecord>(kOneStatement, [&](PgConnection& connection, Deadline deadline) {
    return FindJourney(connection, name, deadline);
  });
}

absl::StatusOr<std::vector<JourneyRecord>> PostgresJourneyStore::ListJourneys(
    const std::string& prefix, const std::string& after, int limit) {
  return Read<std::vector<JourneyRecord>>(
      kOneStatement, [&](PgConnection& connection, Deadline deadline) {
        return ListJourneyRows(connection, prefix, after, limit, deadline);
      });
}

absl::Status PostgresJourneyStore::DeleteJourney(const std::string& name) {
  bool is_repeated = false;
  return Write(kTransaction, [&](PgConnection& connection, Deadline deadline) {
    const absl::Status status = DeleteJourneyRow(connection, name, deadline);
    // The first try may have deleted it.
    return std::exchange(is_repeated, true) && absl::IsNotFound(status) ? absl::OkStatus() : status;
  });
}

absl::Status PostgresJourneyStore::FinishJourney(const std::string& name) {
  return Write(kOneStatement, [&](PgConnection& connection, Deadline deadline) {
    return FinishJourneyRow(connection, name, deadline);
  });
}

absl::Status PostgresJourneyStore::SetReaders(const std::string& name,
                                              const std::vector<std::string>& readers) {
  return Write(kOneStatement, [&](PgConnection& connection, Deadline deadline) {
    return SetJourneyReaders(connection, name, readers, deadline);
  });
}

absl::StatusOr<AcquiredJourney> PostgresJourneyStore::AcquireJourney(const std::string& name,
                                                                     const std::string& writer_id) {
  AcquiredJourney acquired;
  const absl::Status status =
      Write(kOneStatement, [&](PgConnection& connection, Deadline deadline) -> absl::Status {
        HOMING_ASSIGN_OR_RETURN(
            acquired.epoch, AcquireJourneyRow(connection, name, writer_id, server_id_, deadline));
        HOMING_ASSIGN_OR_RETURN(acquired.record, FindJourney(connection, name, deadline));
        return absl::OkStatus();
      });
  HOMING_RETURN_IF_ERROR(status);
  writer_.Forget(name);
  return acquired;
}

absl::Status PostgresJourneyStore::CheckLease(const std::string& name,
                                              const std::string& writer_id) {
  return readers_.ReadOnce([&](PgConnection& connection, Deadline deadline) {
    return CheckLeaseRow(connection, name, writer_id, server_id_, deadline);
  });
}

std::vector<absl::Status> PostgresJourneyStore::AppendSteps(
    const std::vector<JourneyAppend>& appends) {
  if (read_only()) return std::vector<absl::Status>(appends.size(), ReadOnlyError());
  std::vector<absl::Status> statuses = writer_.Append(appends);
  for (const absl::Status& status : statuses) heartbeat_->NoteWrite(status);
  return statuses;
}

absl::StatusOr<JourneyMap> PostgresJourneyStore::LoadMap(const std::string& name) {
  return Read<JourneyMap>(
      kTransaction, [&](PgConnection& connection, Deadline deadline) -> absl::StatusOr<JourneyMap> {
        HOMING_ASSIGN_OR_RETURN(const JourneyRecord record,
                                FindJourney(connection, name, deadline));
        HOMING_ASSIGN_OR_RETURN(const PgRows rows,
                                SelectSteps(connection, JourneyId(name), 0, deadline));
        return AssembleMap(record, ReaderOf(rows));
      });
}

absl::StatusOr<JourneyGrowth> PostgresJourneyStore::LoadSteps(const std::string& name,
                                                              std::int64_t first) {
  return Read<JourneyGrowth>(
      kTransaction,
      [&](PgConnection& connection, Deadline deadline) -> absl::StatusOr<JourneyGrowth> {
        JourneyGrowth growth;
        HOMING_ASSIGN_OR_RETURN(growth.record, FindJourney(connection, name, deadline));
        HOMING_ASSIGN_OR_RETURN(const PgRows rows,
                                SelectSteps(connection, JourneyId(name), first, deadline));
        HOMING_ASSIGN_OR_RETURN(growth.steps, AssembleSteps(growth.record, ReaderOf(rows)));
        return growth;
      });
}

absl::StatusOr<std::vector<JourneyMark>> PostgresJourneyStore::LoadMarks(
    const std::vector<std::string>& names) {
  return Read<std::vector<JourneyMark>>(kOneStatement,
                                        [&](PgConnection& connection, Deadline deadline) {
                                          return LoadJourneyMarks(connection, names, deadline);
                                        });
}

absl::StatusOr<JourneyTail> PostgresJourneyStore::LoadTail(const std::string& name) {
  return Read<JourneyTail>(
      kTransaction,
      [&](PgConnection& connection, Deadline deadline) -> absl::StatusOr<JourneyTail> {
        HOMING_ASSIGN_OR_RETURN(const JourneyRecord record,
                                FindJourney(connection, name, deadline));
        const std::int64_t id = JourneyId(name);
        HOMING_ASSIGN_OR_RETURN(const std::int64_t last,
                                FindLastSequence(connection, id, record.step_count, deadline));
        const std::int64_t first = FirstTailStep(record.settings, record.step_count);
        HOMING_ASSIGN_OR_RETURN(const PgRows rows, SelectSteps(connection, id, first, deadline));
        return AssembleTail(record, last, ReaderOf(rows));
      });
}

absl::Status PostgresJourneyStore::ImportJourney(const JourneyRecord& record,
                                                 const JourneyMap& map) {
  HOMING_RETURN_IF_ERROR(Validate(record.settings));
  const JourneyRecord finished = FinishedRecord(record, map);
  bool is_repeated = false;
  return Write(kTransaction, [&](PgConnection& connection, Deadline deadline) -> absl::Status {
    const absl::Status status = InsertJourney(connection, finished, deadline);
    if (std::exchange(is_repeated, true) && absl::IsAlreadyExists(status)) {
      // The first try may have stored it.
      const auto stored = FindJourney(connection, record.name, deadline);
      const bool is_ours = stored.ok() && stored->create_time_ns == record.create_time_ns;
      return is_ours ? absl::OkStatus() : status;
    }
    HOMING_RETURN_IF_ERROR(status);
    return InsertMap(connection, JourneyId(record.name), map, deadline);
  });
}

absl::StatusOr<std::unique_ptr<std::istream>> PostgresJourneyStore::BackUp() {
  return absl::FailedPreconditionError(
      "store: back PostgreSQL up with its own tools, such as pg_dump and pg_basebackup "
      "(docs/operations.md)");
}

absl::Status PostgresJourneyStore::CreateModel(const StoredModel& model) {
  return Write(kOneStatement, [&](PgConnection& connection, Deadline deadline) {
    return InsertModel(connection, model, deadline);
  });
}

absl::StatusOr<StoredModel> PostgresJourneyStore::GetModel(const std::string& name) {
  return Read<StoredModel>(kOneStatement, [&](PgConnection& connection, Deadline deadline) {
    return FindModel(connection, name, deadline);
  });
}

absl::StatusOr<std::vector<StoredModel>> PostgresJourneyStore::ListModels(const std::string& after,
                                                                          int limit) {
  return Read<std::vector<StoredModel>>(kOneStatement,
                                        [&](PgConnection& connection, Deadline deadline) {
                                          return ListModelRows(connection, after, limit, deadline);
                                        });
}

}  // namespace postgres
}  // namespace homing::storage
