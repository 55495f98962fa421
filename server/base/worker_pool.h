// A fixed number of threads does all computing; tasks of one stream run in order.
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

// Tasks must not throw. Thread-safe. The first pool makes OpenCV single-threaded in this process,
// so that `workers` is the whole parallelism.
class WorkerPool {
 public:
  using Task = std::function<void()>;

  // Starts at least one thread. TryRun refuses when `max_waiting` tasks wait.
  explicit WorkerPool(int workers, int max_waiting = 1024);
  // Runs all waiting tasks, then stops.
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  // False: too many tasks wait, and `task` is not run.
  [[nodiscard]] bool TryRun(Task task);
  // Never refuses. The caller must bound its tasks (a Strand has at most one waiting).
  void Run(Task task);
  // The number of waiting tasks.
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
  // Runs the task on the caller's thread before it returns, unless another task of this strand runs
  // or waits.
  void RunOrPost(WorkerPool::Task task);

 private:
  void RunSome();
  void ScheduleRest();

  WorkerPool* const pool_;
  Mutex mutex_;
  // A list and not a deque: an empty deque takes 600 bytes, and there are many strands.
  std::list<WorkerPool::Task> tasks_ HOMING_GUARDED_BY(mutex_);
  bool scheduled_ HOMING_GUARDED_BY(mutex_) = false;
};

}  // namespace homing::server

#endif  // SERVER_BASE_WORKER_POOL_H_
