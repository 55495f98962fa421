// Connections that are fit for this program: checked for the durability that the store promises.
#ifndef STORAGE_POSTGRES_PG_SESSION_H_
#define STORAGE_POSTGRES_PG_SESSION_H_

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/base/mutex.h"
#include "storage/postgres/pg_connection.h"

namespace homing::storage::postgres {

// Thread-safe.
class PgDatabase {
 public:
  PgDatabase(std::string url, PgConnection::Access access)
      : url_(std::move(url)), access_(access) {}

  // FAILED_PRECONDITION: synchronous_commit is off or local, or fsync is off: an acknowledged step
  // could be lost; the encoding is not UTF-8. UNAVAILABLE: no host accepts writes but a primary
  // whose timeline is lower than one seen before, that is one that was replaced.
  absl::StatusOr<std::unique_ptr<PgConnection>> Connect(Deadline deadline);
  PgConnection::Access access() const { return access_; }

 private:
  absl::StatusOr<std::unique_ptr<PgConnection>> ConnectTo(const std::optional<PgHost>& host,
                                                          Deadline deadline);
  absl::Status CheckTimeline(std::int64_t timeline);

  const std::string url_;
  const PgConnection::Access access_;
  std::atomic<std::int64_t> highest_timeline_ = 0;
};

// A few connections that are opened when needed and used by one thread at a time. Thread-safe.
class PgPool {
 public:
  using Body = std::function<absl::Status(PgConnection&, Deadline)>;

  // `database` must outlive it.
  PgPool(PgDatabase* database, int most) : database_(database), unopened_(most) {}

  // Runs `body` in one read-only transaction that sees one moment; again on a new connection if the
  // first was lost.
  absl::Status Read(const Body& body);
  // The same for a `body` of one statement, which needs no transaction around it.
  absl::Status ReadOnce(const Body& body);
  // Runs `body` once, outside of a transaction. OUT: there is no connection, or it was lost.
  absl::Status Use(const Body& body, Deadline deadline, bool* is_lost);

 private:
  absl::StatusOr<std::unique_ptr<PgConnection>> Take(Deadline deadline);
  void GiveBack(std::unique_ptr<PgConnection> connection);

  PgDatabase* const database_;
  Mutex mutex_;
  ConditionVariable given_back_;
  std::vector<std::unique_ptr<PgConnection>> free_ HOMING_GUARDED_BY(mutex_);
  int unopened_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::storage::postgres

#endif  // STORAGE_POSTGRES_PG_SESSION_H_
