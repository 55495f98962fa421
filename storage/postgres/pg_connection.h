// One connection to PostgreSQL, by libpq: prepared statements, each with a deadline. TCP's timeouts
// do not detect a stopped server, which neither answers nor closes its connections.
#ifndef STORAGE_POSTGRES_PG_CONNECTION_H_
#define STORAGE_POSTGRES_PG_CONNECTION_H_

#include <libpq-fe.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "storage/postgres/pg_arguments.h"

namespace homing::storage::postgres {

using Deadline = std::chrono::steady_clock::time_point;

inline Deadline After(std::chrono::milliseconds time) {
  return std::chrono::steady_clock::now() + time;
}

// The rows of one statement: bigint, double precision, text and bytea, in binary. Immutable.
class PgRows {
 public:
  explicit PgRows(PGresult* result) : result_(result, &PQclear) {}

  int size() const { return PQntuples(result_.get()); }
  // Rows that INSERT, UPDATE or DELETE changed.
  std::int64_t changed() const;
  bool IsNull(int row, int column) const { return PQgetisnull(result_.get(), row, column) != 0; }
  // 0 and "" for NULL.
  std::int64_t Integer(int row, int column) const;
  double Real(int row, int column) const;
  std::string Text(int row, int column) const;

 private:
  std::unique_ptr<PGresult, void (*)(PGresult*)> result_;
};

// One of the rows, which must outlive it.
struct PgRow {
  std::int64_t Integer(int column) const { return rows.Integer(row, column); }
  double Real(int column) const { return rows.Real(row, column); }
  std::string Text(int column) const { return rows.Text(row, column); }

  const PgRows& rows;
  int row = 0;
};

// One of the hosts of a URL, each as in libpq's parameter of that name; empty: not set.
struct PgHost {
  std::string host;
  std::string hostaddr;
  std::string port;
};

// All of a URL; none if it is not a valid one.
std::vector<PgHost> HostsOf(const std::string& url);

// Not thread-safe.
class PgConnection {
 public:
  enum class Access { kReadWrite, kReadOnly };

  // `url` as libpq reads it; of several hosts the first that accepts, each of which has two seconds
  // unless the URL sets connect_timeout. FAILED_PRECONDITION: no such database or no right to it;
  // INVALID_ARGUMENT: the URL; UNAVAILABLE.
  // With `host`, only that one.
  static absl::StatusOr<std::unique_ptr<PgConnection>> Open(
      const std::string& url, Access access, const std::optional<PgHost>& host = std::nullopt);
  ~PgConnection();
  PgConnection(const PgConnection&) = delete;
  PgConnection& operator=(const PgConnection&) = delete;

  // Runs one statement. `sql` must be a literal: its address is the key of the prepared statement.
  absl::StatusOr<PgRows> Run(const char* sql, const PgArguments& arguments, Deadline deadline);
  // Runs any number of statements, in one transaction unless they contain BEGIN or COMMIT.
  absl::Status Execute(const std::string& sql, Deadline deadline);

  // The last statement may have been committed or not: the connection was lost or the deadline
  // passed before the answer, or the server gave up waiting for its replica, which it reports as
  // success with a warning. The connection is of no further use.
  bool in_doubt() const { return in_doubt_; }
  // The connection is of no further use.
  bool is_lost() const { return in_doubt_ || PQstatus(connection_) != CONNECTION_OK; }

 private:
  explicit PgConnection(PGconn* connection) : connection_(connection) {}
  absl::Status Prepare(const char* sql, const PgArguments& arguments, Deadline deadline);
  // Waits until a result can be taken without blocking.
  absl::Status AwaitResult(Deadline deadline);
  // Reads all results of the sent statements; returns the last one, or the first error.
  absl::StatusOr<PgRows> TakeResults(Deadline deadline);
  absl::Status Lost(const std::string& why);
  static void NoteWarning(void* connection, const PGresult* notice);

  PGconn* const connection_;
  bool in_doubt_ = false;
  bool warned_ = false;
  std::unordered_map<const char*, std::string> prepared_;
};

}  // namespace homing::storage::postgres

#endif  // STORAGE_POSTGRES_PG_CONNECTION_H_
