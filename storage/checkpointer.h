// Moves committed pages from SQLite's log into the file, beside the writer. A thousand journeys
// change some thousand pages a second; moving them takes longer than a robot should wait for its
// answer. See https://sqlite.org/wal.html, 2.1.
#ifndef STORAGE_CHECKPOINTER_H_
#define STORAGE_CHECKPOINTER_H_

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "absl/status/statusor.h"
#include "homing/base/mutex.h"
#include "storage/connection.h"

namespace homing::storage {

// One thread with its own connection. It moves most pages while the writer continues, and the last
// few while it blocks the writer, so that the log starts again at its beginning.
class Checkpointer {
 public:
  // Starts it for the file at `path`. Only `writer` writes the file, with `write_mutex` held; both
  // must outlive this object. Replaces the writer's own checkpoints. Errors of Connection::Open.
  static absl::StatusOr<std::unique_ptr<Checkpointer>> Start(const std::string& path,
                                                             Connection* writer, Mutex* write_mutex,
                                                             int busy_timeout_ms);
  // Pages in the log as of the last commit.
  int pages_in_log() const { return pages_in_log_; }
  // The current number in SQLite: another program may have moved the log into the file. -1:
  // unknown. Thread-safe.
  int CountPagesInLog();

  // Moves the log already when it has `pages` pages, if these are fewer than usual. Thread-safe.
  void LimitLog(std::int64_t pages);
  // Moves all pages now, with the writer blocked, so that the log starts again at its beginning.
  // REQUIRES: the caller does not hold the write mutex.
  void MoveNow() { MoveAll(); }

  // Waits for the current work.
  ~Checkpointer();
  Checkpointer(const Checkpointer&) = delete;
  Checkpointer& operator=(const Checkpointer&) = delete;

 private:
  Checkpointer(std::unique_ptr<Connection> connection, Connection* writer, Mutex* write_mutex);
  // Called after each commit with the length of the log.
  void NoteLog(int pages);
  void Run();
  void MoveAll();
  // Returns the pages that remain to be moved; negative: it failed.
  int Move();

  std::atomic<int> pages_in_log_ = 0;
  // Held while connection_ is used.
  Mutex connection_mutex_;
  const std::unique_ptr<Connection> connection_;
  Connection* const writer_;
  Mutex* const write_mutex_;
  Mutex mutex_;
  ConditionVariable changed_;
  bool due_ HOMING_GUARDED_BY(mutex_) = false;
  bool stopping_ HOMING_GUARDED_BY(mutex_) = false;
  // Length of the log, in pages, at which it is moved next. The writer's thread uses it.
  int next_at_;
  // As next_at_, while the log is short.
  std::atomic<int> due_pages_;
  std::thread thread_;
};

}  // namespace homing::storage

#endif  // STORAGE_CHECKPOINTER_H_
