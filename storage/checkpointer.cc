#include "storage/checkpointer.h"

#include <sqlite3.h>

#include <algorithm>
#include <utility>

#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"

namespace homing::storage {
namespace {

// Length of the log, in pages, at which it is moved: 48 of the 64 MiB that it may keep. A page that
// changes often is then moved once.
constexpr int kDuePages = 12288;
// Pages until the next attempt after one that did not empty the log (a reader needs it, the disk is
// full).
constexpr int kPagesToNextTry = 1024;
// At most this many pages are moved while the writer waits: a few milliseconds.
constexpr int kFewPages = 512;
constexpr int kMostRounds = 5;

}  // namespace

absl::StatusOr<std::unique_ptr<Checkpointer>> Checkpointer::Start(const std::string& path,
                                                                  Connection* writer,
                                                                  Mutex* write_mutex,
                                                                  int busy_timeout_ms) {
  HOMING_ASSIGN_OR_RETURN(auto connection,
                          Connection::Open(path, Connection::Access::kReadWrite, busy_timeout_ms));
  HOMING_RETURN_IF_ERROR(connection->Run([&] {
    // The log is durable before the file changes, and the file before the log is reused.
    connection->Execute("PRAGMA synchronous=FULL");
    return absl::OkStatus();
  }));
  return std::unique_ptr<Checkpointer>(
      new Checkpointer(std::move(connection), writer, write_mutex));
}

Checkpointer::Checkpointer(std::unique_ptr<Connection> connection, Connection* writer,
                           Mutex* write_mutex)
    : connection_(std::move(connection)),
      writer_(writer),
      write_mutex_(write_mutex),
      next_at_(kDuePages),
      due_pages_(kDuePages),
      thread_([this] { Run(); }) {
  sqlite3_wal_hook(
      writer_->database().getHandle(),
      [](void* self, sqlite3*, const char*, int pages) {
        static_cast<Checkpointer*>(self)->NoteLog(pages);
        return SQLITE_OK;
      },
      this);
}

Checkpointer::~Checkpointer() {
  sqlite3_wal_hook(writer_->database().getHandle(), nullptr, nullptr);
  {
    const MutexLock lock(mutex_);
    stopping_ = true;
  }
  changed_.NotifyOne();
  thread_.join();
}

void Checkpointer::LimitLog(std::int64_t pages) {
  due_pages_ = static_cast<int>(std::clamp<std::int64_t>(pages, kFewPages, kDuePages));
}

void Checkpointer::NoteLog(int pages) {
  pages_in_log_ = pages;
  if (pages < due_pages_) next_at_ = due_pages_;
  if (pages < next_at_) return;
  next_at_ = pages + kPagesToNextTry;
  {
    const MutexLock lock(mutex_);
    due_ = true;
  }
  changed_.NotifyOne();
}

void Checkpointer::Run() {
  MutexLock lock(mutex_);
  while (true) {
    while (!stopping_ && !due_) changed_.Wait(mutex_);
    if (stopping_) return;
    due_ = false;
    lock.Unlock();
    MoveAll();
    lock.Lock();
  }
}

void Checkpointer::MoveAll() {
  int left = kFewPages + 1;
  for (int round = 0; round < kMostRounds && left > kFewPages; ++round) left = Move();
  if (left < 0) return;
  const MutexLock lock(*write_mutex_);
  Move();
}

int Checkpointer::CountPagesInLog() {
  const MutexLock lock(connection_mutex_);
  int in_log = 0;
  const int code = sqlite3_wal_checkpoint_v2(connection_->database().getHandle(), nullptr,
                                             SQLITE_CHECKPOINT_PASSIVE, &in_log, nullptr);
  return code == SQLITE_OK ? in_log : -1;
}

int Checkpointer::Move() {
  const MutexLock lock(connection_mutex_);
  int in_log = 0;
  int moved = 0;
  const int code = sqlite3_wal_checkpoint_v2(connection_->database().getHandle(), nullptr,
                                             SQLITE_CHECKPOINT_PASSIVE, &in_log, &moved);
  return code == SQLITE_OK ? in_log - moved : -1;
}

}  // namespace homing::storage
