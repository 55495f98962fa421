// The connections of a server that write: one appends steps, a few make other changes. A robot that
// begins a journey does not wait for the batch of all others.
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
  explicit PgWriter(PgDatabase* database) : database_(database), changes_(database, kMostChanges) {}

  // Runs `body`; again after a lost connection or a conflict, for a while. `body` must know that
  // its first try may have been committed. kOneStatement: only one statement of it writes. A server
  // that is paused then leaves no transaction open, whose row locks would hold up others.
  enum class Scope { kOneStatement, kTransaction };
  absl::Status Write(Scope scope, const Body& body);
  // As JourneyStore::AppendSteps.
  std::vector<absl::Status> Append(const std::vector<JourneyAppend>& appends);
  // As PgAppends::Forget, for appends that begin from now on.
  void Forget(const std::string& name);

 private:
  // Changes at the same time.
  static constexpr int kMostChanges = 3;

  absl::StatusOr<PgConnection*> Connection(Deadline deadline) HOMING_REQUIRES(mutex_);
  void ApplyForgotten() HOMING_REQUIRES(mutex_);

  PgDatabase* const database_;
  PgPool changes_;
  // An append may hold mutex_ for long. Lock order: mutex_, forget_mutex_.
  Mutex forget_mutex_;
  std::vector<std::string> forgotten_ HOMING_GUARDED_BY(forget_mutex_);
  Mutex mutex_;
  std::unique_ptr<PgConnection> connection_ HOMING_GUARDED_BY(mutex_);
  PgAppends appends_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::storage::postgres

#endif  // STORAGE_POSTGRES_PG_WRITER_H_
