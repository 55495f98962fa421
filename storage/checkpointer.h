// Moves what was committed from SQLite's log into the file, beside the writer: a thousand journeys
// change some thousand pages a second, and to move them takes longer than a robot should wait for
// its answer. Source: own design; https://sqlite.org/wal.html, 2.1.
#ifndef STORAGE_CHECKPOINTER_H_
#define STORAGE_CHECKPOINTER_H_

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "absl/status/statusor.h"
#include "storage/connection.h"

namespace homing::storage {

// One thread with a connection of its own. Most is moved while the writer goes on; the rest, a few
// pages, while it holds the writer back, so that the log begins anew.
class Checkpointer {
 public:
  // Of the file at `path`, which `writer` alone writes, with `write_mutex` held; both must outlive
  // it. Takes the place of the writer's own checkpoints. As Connection::Open.
  static absl::StatusOr<std::unique_ptr<Checkpointer>> Start(const std::string& path,
                                                             Connection* writer,
                                                             std::mutex* write_mutex,
                                                             int busy_timeout_ms);
  // As of the last commit.
  int pages_in_log() const { return pages_in_log_; }
  // As SQLite knows it now: another program may have moved the log into the file. -1: unknown.
  // Thread-safe.
  int CountPagesInLog();

  // Ends what it does.
  ~Checkpointer();
  Checkpointer(const Checkpointer&) = delete;
  Checkpointer& operator=(const Checkpointer&) = delete;

 private:
  Checkpointer(std::unique_ptr<Connection> connection, Connection* writer, std::mutex* write_mutex);
  // After each commit.
  void NoteLog(int pages);
  void Run();
  void MoveAll();
  // Pages that are still to be moved when it returns; negative: it could not be done.
  int Move();

  std::atomic<int> pages_in_log_ = 0;
  // While connection_ is used.
  std::mutex connection_mutex_;
  const std::unique_ptr<Connection> connection_;
  Connection* const writer_;
  std::mutex* const write_mutex_;
  std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by mutex_.
  bool due_ = false;
  bool stopping_ = false;
  // Of the log, when it is next due; the writer's.
  int next_at_;
  std::thread thread_;
};

}  // namespace homing::storage

#endif  // STORAGE_CHECKPOINTER_H_
