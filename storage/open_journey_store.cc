// Opens a store: URL, file, schema, durability.
#include <algorithm>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "storage/connection.h"
#include "storage/database_url.h"
#include "storage/journey_store.h"
#include "storage/postgres_store.h"
#include "storage/query_connections.h"
#include "storage/schema.h"
#include "storage/sqlite_journey_store.h"

namespace homing::storage {
namespace {

constexpr char kInMemory[] = ":memory:";
// Connections that read while the writer writes.
constexpr int kMaxQueryConnections = 4;

// Makes every commit durable when it returns, and bounds the log.
absl::Status MakeDurable(Connection& connection, const std::string& path) {
  return connection.Run([&]() -> absl::Status {
    const std::string mode = connection.Text("PRAGMA journal_mode=WAL");
    if (mode != "wal" && path != kInMemory) {
      return absl::FailedPreconditionError(absl::StrCat("store: journal_mode of '", path, "' is ",
                                                        mode,
                                                        ": the file system does not support WAL"));
    }
    connection.Execute("PRAGMA synchronous=FULL");
    connection.Execute("PRAGMA journal_size_limit=67108864");
    // KiB: a thousand growing journeys use about 1,500 pages.
    connection.Execute("PRAGMA cache_size=-6144");
    return absl::OkStatus();
  });
}

absl::Status LimitSize(Connection& connection, std::int64_t max_bytes) {
  if (max_bytes <= 0) return absl::OkStatus();
  return connection.Run([&] {
    const std::int64_t page = connection.Integer("PRAGMA page_size");
    connection.Integer(
        absl::StrCat("PRAGMA max_page_count=", std::max<std::int64_t>(1, max_bytes / page)));
    return absl::OkStatus();
  });
}

// A server that stopped cleanly leaves no log, or an empty one.
absl::Status CheckClosedWell(const std::string& path) {
  if (!HasLog(path)) return absl::OkStatus();
  return absl::FailedPreconditionError(absl::StrCat(
      "store: '", path,
      "-wal' holds pages that are not in the file, which was not closed cleanly: start "
      "homing-server on it once without --readonly, or make a backup"));
}

absl::StatusOr<std::unique_ptr<JourneyStore>> OpenReadOnly(const std::string& path,
                                                           const StoreOptions& options) {
  constexpr auto kAccess = Connection::Access::kImmutable;
  HOMING_ASSIGN_OR_RETURN(auto lock, StoreLock::TakeShared(path));
  HOMING_RETURN_IF_ERROR(CheckClosedWell(path));
  HOMING_ASSIGN_OR_RETURN(const auto first,
                          Connection::Open(path, kAccess, options.busy_timeout_ms));
  HOMING_RETURN_IF_ERROR(CheckSchema(*first));
  return std::make_unique<SqliteJourneyStore>(
      path, std::move(lock), nullptr,
      std::make_unique<QueryConnections>(path, kAccess, options.busy_timeout_ms,
                                         kMaxQueryConnections));
}

}  // namespace

absl::StatusOr<std::unique_ptr<JourneyStore>> OpenJourneyStore(const StoreOptions& options) {
  if (IsPostgresUrl(options.url)) return OpenPostgresStore(options);
  HOMING_ASSIGN_OR_RETURN(const std::string path, ParseDatabaseUrl(options.url));
  if (options.read_only && path != kInMemory) return OpenReadOnly(path, options);
  // Released last.
  std::unique_ptr<StoreLock> lock;
  HOMING_ASSIGN_OR_RETURN(
      std::unique_ptr<Connection> writer,
      Connection::Open(path, Connection::Access::kReadWrite, options.busy_timeout_ms));
  std::unique_ptr<SpaceReserve> reserve;
  if (path != kInMemory) {
    HOMING_ASSIGN_OR_RETURN(lock, StoreLock::Take(path));
    reserve = std::make_unique<SpaceReserve>(path);
  }
  HOMING_RETURN_IF_ERROR(Migrate(*writer));
  HOMING_RETURN_IF_ERROR(MakeDurable(*writer, path));
  HOMING_RETURN_IF_ERROR(LimitSize(*writer, options.max_bytes));
  std::unique_ptr<QueryConnections> queries;
  if (path != kInMemory) {
    queries = std::make_unique<QueryConnections>(path, Connection::Access::kReadOnly,
                                                 options.busy_timeout_ms, kMaxQueryConnections);
  }
  auto store = std::make_unique<SqliteJourneyStore>(path, std::move(lock), std::move(writer),
                                                    std::move(queries));
  if (path != kInMemory) {
    HOMING_RETURN_IF_ERROR(store->StartCheckpoints(options.busy_timeout_ms));
    store->KeepReserve(std::move(reserve));
    // On a full disk this may fail; the next deletion tries again.
    store->FinishDeletions().IgnoreError();
  }
  return store;
}

}  // namespace homing::storage
