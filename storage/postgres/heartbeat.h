// Shows the other servers that this one is alive, and whether the database accepts writes.
#ifndef STORAGE_POSTGRES_HEARTBEAT_H_
#define STORAGE_POSTGRES_HEARTBEAT_H_

#include <cstdint>
#include <memory>
#include <thread>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/base/mutex.h"
#include "storage/postgres/pg_session.h"

namespace homing::storage::postgres {

// One thread with its own connection writes one row a server. Thread-safe.
class Heartbeat {
 public:
  // `database` must outlive it. Errors of the first beat.
  static absl::StatusOr<std::unique_ptr<Heartbeat>> Start(PgDatabase* database,
                                                          std::int64_t server_id);
  // Removes the row: the journeys that writers hold through this server are free at once.
  ~Heartbeat();
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;

  // Writes the row now. Returns health().
  absl::Status Beat();
  // Reports the result of another write.
  void NoteWrite(const absl::Status& written);
  // OK, or the fault of the store that the last write met.
  absl::Status health();

 private:
  Heartbeat(PgDatabase* database, std::int64_t server_id)
      : database_(database), server_id_(server_id) {}
  void Run();

  PgDatabase* const database_;
  const std::int64_t server_id_;

  Mutex beat_mutex_;
  std::unique_ptr<PgConnection> connection_ HOMING_GUARDED_BY(beat_mutex_);

  Mutex mutex_;
  ConditionVariable stopped_;
  bool stopping_ HOMING_GUARDED_BY(mutex_) = false;
  absl::Status health_ HOMING_GUARDED_BY(mutex_);
  std::thread thread_;
};

}  // namespace homing::storage::postgres

#endif  // STORAGE_POSTGRES_HEARTBEAT_H_
