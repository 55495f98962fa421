#include "storage/postgres/pg_session.h"

#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"

namespace homing::storage::postgres {
namespace {

// Limits the wait for another transaction's row, and ends transactions that a dead server left
// open.
constexpr char kSettings[] =
    "SET lock_timeout = '2s'; SET idle_in_transaction_session_timeout = '3s';"
    " SET client_min_messages = 'warning'";
// Sets synchronous_commit to the value that is checked: a later change of the configuration then
// leaves this connection alone. pg_control_checkpoint() still shows the old timeline right after a
// promotion; the name of the current log file does not.
constexpr char kDescribe[] =
    "SELECT set_config('synchronous_commit', current_setting('synchronous_commit'), false),"
    " current_setting('fsync'),"
    " current_setting('server_encoding'), CASE WHEN pg_is_in_recovery() THEN 0::bigint ELSE"
    " ('x' || substr(pg_walfile_name(pg_current_wal_lsn()), 1, 8))::bit(32)::bigint END";

// Reading a long journey takes half a second.
constexpr std::chrono::milliseconds kReadTime{30'000};

constexpr char kReplaced[] = "store: the database was replaced by another: ";

bool IsReplaced(const absl::Status& status) {
  return absl::StartsWith(status.message(), kReplaced);
}

}  // namespace

absl::StatusOr<std::unique_ptr<PgConnection>> PgDatabase::Connect(Deadline deadline) {
  auto connection = ConnectTo(std::nullopt, deadline);
  if (!IsReplaced(connection.status())) return connection;
  // libpq would choose the replaced primary each time.
  for (const PgHost& host : HostsOf(url_)) {
    auto other = ConnectTo(host, deadline);
    if (other.ok()) return other;
  }
  return connection;
}

absl::StatusOr<std::unique_ptr<PgConnection>> PgDatabase::ConnectTo(
    const std::optional<PgHost>& host, Deadline deadline) {
  HOMING_ASSIGN_OR_RETURN(auto connection, PgConnection::Open(url_, access_, host));
  HOMING_RETURN_IF_ERROR(connection->Execute(kSettings, deadline));
  HOMING_ASSIGN_OR_RETURN(const PgRows rows, connection->Run(kDescribe, {}, deadline));
  if (rows.Text(0, 2) != "UTF8") {
    return absl::FailedPreconditionError(
        absl::StrCat("store: the database's encoding must be UTF8, not ", rows.Text(0, 2)));
  }
  if (access_ == PgConnection::Access::kReadOnly) return connection;
  const std::string commit = rows.Text(0, 0);
  if (commit == "off" || commit == "local" || rows.Text(0, 1) != "on") {
    return absl::FailedPreconditionError(absl::StrCat(
        "store: synchronous_commit is ", commit, " and fsync is ", rows.Text(0, 1),
        ": synchronous_commit must be on, remote_write or remote_apply and fsync on, or "
        "acknowledged steps could be lost"));
  }
  HOMING_RETURN_IF_ERROR(CheckTimeline(rows.Integer(0, 3)));
  return connection;
}

absl::Status PgDatabase::CheckTimeline(std::int64_t timeline) {
  std::int64_t highest = highest_timeline_;
  while (timeline > highest && !highest_timeline_.compare_exchange_weak(highest, timeline)) {
  }
  if (timeline >= highest) return absl::OkStatus();
  return absl::UnavailableError(absl::StrCat(kReplaced, "it is on timeline ", timeline,
                                             ", and the one in use on timeline ", highest));
}

absl::StatusOr<std::unique_ptr<PgConnection>> PgPool::Take(Deadline deadline) {
  {
    MutexLock lock(mutex_);
    while (free_.empty() && unopened_ == 0) {
      if (!given_back_.WaitUntil(mutex_, deadline)) {
        return absl::UnavailableError("store: all connections to the database are in use");
      }
    }
    if (!free_.empty()) {
      std::unique_ptr<PgConnection> connection = std::move(free_.back());
      free_.pop_back();
      return connection;
    }
    --unopened_;
  }
  auto connection = database_->Connect(deadline);
  if (!connection.ok()) GiveBack(nullptr);
  return connection;
}

void PgPool::GiveBack(std::unique_ptr<PgConnection> connection) {
  const MutexLock lock(mutex_);
  if (connection != nullptr && !connection->is_lost()) {
    free_.push_back(std::move(connection));
  } else {
    ++unopened_;
  }
  given_back_.NotifyOne();
}

absl::Status PgPool::Use(const Body& body, Deadline deadline, bool* is_lost) {
  *is_lost = true;
  HOMING_ASSIGN_OR_RETURN(std::unique_ptr<PgConnection> connection, Take(deadline));
  absl::Status status = body(*connection, deadline);
  *is_lost = connection->is_lost();
  GiveBack(std::move(connection));
  return status;
}

absl::Status PgPool::Read(const Body& body) {
  return ReadOnce([&](PgConnection& connection, Deadline deadline) {
    HOMING_RETURN_IF_ERROR(
        connection.Execute("BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY", deadline));
    const absl::Status status = body(connection, deadline);
    const absl::Status ended = connection.Execute("COMMIT", deadline);
    return status.ok() ? ended : status;
  });
}

absl::Status PgPool::ReadOnce(const Body& body) {
  bool is_connected = false;
  bool is_lost = false;
  const Body noted = [&](PgConnection& connection, Deadline deadline) {
    is_connected = true;
    return body(connection, deadline);
  };
  absl::Status status = Use(noted, After(kReadTime), &is_lost);
  // The other kept connections may be lost too: they were made before the same restart.
  for (int tries = 0; !status.ok() && is_lost && is_connected && tries < 5; ++tries) {
    is_connected = false;
    status = Use(noted, After(kReadTime), &is_lost);
  }
  return status;
}

}  // namespace homing::storage::postgres
