// A fixed number of threads for all computing; in-order execution within a stream.
#ifndef SERVER_BASE_WORKER_POOL_H_
#define SERVER_BASE_WORKER_POOL_H_

#include <deque>
#include <functional>
#include <list>
#include <memory>
#include <thread>
#include <vector>

#include "homing/base/mutex.h"

namespace homing::server {

// Tasks must not throw. Thread-safe. OpenCV runs single-threaded in this process from the first
// pool on, so that `workers` is all the parallelism there is.
class WorkerPool {
 public:
  using Task = std::function<void()>;

  // At least one thread is made. Above `max_waiting` waiting tasks TryRun refuses.
  explicit WorkerPool(int workers, int max_waiting = 1024);
  // Runs all that waits, then ends.
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  // False, and the task is not run, when too many wait.
  [[nodiscard]] bool TryRun(Task task);
  // Never refused: the caller bounds itself (a Strand waits at most once).
  void Run(Task task);
  // Tasks that wait.
  std::size_t waiting() const;

 private:
  void Work();

  const std::size_t max_waiting_;
  mutable Mutex mutex_;
  ConditionVariable changed_;
  std::deque<Task> tasks_ HOMING_GUARDED_BY(mutex_);
  bool stopping_ HOMING_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};

// Tasks of one stream: one at a time, in the order posted. Thread-safe.
class Strand : public std::enable_shared_from_this<Strand> {
 public:
  // `pool` must outlive all tasks.
  explicit Strand(WorkerPool* pool) : pool_(pool) {}

  void Post(WorkerPool::Task task);
  // Runs it before it returns, on the caller's thread, unless another one runs or waits.
  void RunOrPost(WorkerPool::Task task);

 private:
  void RunSome();
  void GoOn();

  WorkerPool* const pool_;
  Mutex mutex_;
  // An empty deque takes 600 bytes, and strands are many.
  std::list<WorkerPool::Task> tasks_ HOMING_GUARDED_BY(mutex_);
  bool scheduled_ HOMING_GUARDED_BY(mutex_) = false;
};

}  // namespace homing::server

#endif  // SERVER_BASE_WORKER_POOL_H_
