// Moves what was committed from SQLite's log into the file, beside the writer: a thousand journeys
// change some thousand pages a second, and to move them takes longer than a robot should wait for
// its answer. See https://sqlite.org/wal.html, 2.1.
#ifndef STORAGE_CHECKPOINTER_H_
#define STORAGE_CHECKPOINTER_H_

#include <memory>
#include <string>
#include <thread>

#include "absl/status/statusor.h"
#include "homing/base/mutex.h"
#include "storage/connection.h"

namespace homing::storage {

// One thread with a connection of its own. Most is moved while the writer goes on; the rest, a few
// pages, while it holds the writer back, so that the log begins anew.
class Checkpointer {
 public:
  // Of the file at `path`, which `writer` alone writes, with `write_mutex` held; both must outlive
  // it. Takes the place of the writer's own checkpoints. As Connection::Open.
  static absl::StatusOr<std::unique_ptr<Checkpointer>> Start(const std::string& path,
                                                             Connection* writer, Mutex* write_mutex,
                                                             int busy_timeout_ms);
  // Ends what it does.
  ~Checkpointer();
  Checkpointer(const Checkpointer&) = delete;
  Checkpointer& operator=(const Checkpointer&) = delete;

 private:
  Checkpointer(std::unique_ptr<Connection> connection, Connection* writer, Mutex* write_mutex);
  // After each commit.
  void NoteLog(int pages);
  void Run();
  void MoveAll();
  // Pages that are still to be moved when it returns; negative: it could not be done.
  int Move();

  const std::unique_ptr<Connection> connection_;
  Connection* const writer_;
  Mutex* const write_mutex_;
  Mutex mutex_;
  ConditionVariable changed_;
  bool due_ HOMING_GUARDED_BY(mutex_) = false;
  bool stopping_ HOMING_GUARDED_BY(mutex_) = false;
  // Of the log, when it is next due; the writer's.
  int next_at_;
  std::thread thread_;
};

}  // namespace homing::storage

#endif  // STORAGE_CHECKPOINTER_H_
