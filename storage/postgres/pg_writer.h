// The one connection of a server that writes.
#ifndef STORAGE_POSTGRES_PG_WRITER_H_
#define STORAGE_POSTGRES_PG_WRITER_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/base/mutex.h"
#include "storage/postgres/pg_appends.h"
#include "storage/postgres/pg_session.h"

namespace homing::storage::postgres {

// Thread-safe.
class PgWriter {
 public:
  using Body = PgPool::Body;

  // `database` must outlive it.
  explicit PgWriter(PgDatabase* database) : database_(database) {}

  // Runs `body`; again after a lost connection or a conflict, for a while. `body` must know that
  // its first try may have been committed. kOneStatement: only one statement of it writes. A server
  // that is paused then leaves no transaction open, whose row locks would hold up others.
  enum class Scope { kOneStatement, kTransaction };
  absl::Status Write(Scope scope, const Body& body);
  // As JourneyStore::AppendSteps.
  std::vector<absl::Status> Append(const std::vector<JourneyAppend>& appends);
  // As PgAppends::Forget.
  void Forget(const std::string& name);

 private:
  absl::Status WriteOnce(Scope scope, const Body& body, Deadline deadline) HOMING_REQUIRES(mutex_);
  absl::StatusOr<PgConnection*> Connection(Deadline deadline) HOMING_REQUIRES(mutex_);

  PgDatabase* const database_;
  Mutex mutex_;
  std::unique_ptr<PgConnection> connection_ HOMING_GUARDED_BY(mutex_);
  PgAppends appends_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::storage::postgres

#endif  // STORAGE_POSTGRES_PG_WRITER_H_
