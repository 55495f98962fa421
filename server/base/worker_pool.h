// A fixed number of threads runs tasks; callers take turns, and tasks of a stream run in order.
#ifndef SERVER_BASE_WORKER_POOL_H_
#define SERVER_BASE_WORKER_POOL_H_

#include <functional>
#include <list>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "homing/base/mutex.h"
#include "server/base/turn_queue.h"

namespace homing::server {

// Tasks must not throw. Thread-safe. The first pool makes OpenCV single-threaded in this process,
// so that `workers` is the whole parallelism.
class WorkerPool {
 public:
  using Task = TurnQueue::Task;

  // Starts at least one thread. TryRun refuses when `max_waiting` tasks wait, one of them of this
  // caller: nobody can fill the pool so that others are refused.
  explicit WorkerPool(int workers, int max_waiting = 1024);
  // As Stop.
  ~WorkerPool() { Stop(); }
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  // False: too many tasks wait, and `task` is not run. `caller`: who takes turns with others.
  [[nodiscard]] bool TryRun(Task task, const std::string& caller = "");
  // Never refuses. The caller must bound its tasks (a Strand has at most one waiting). After Stop
  // it runs the task on the caller's thread.
  void Run(Task task, const std::string& caller = "");
  // Runs all waiting tasks, then ends the threads. Of pools whose tasks call each other, all are
  // stopped before the first is destroyed.
  void Stop();
  // The number of waiting tasks.
  std::size_t waiting() const;

 private:
  void Work();

  const std::size_t max_waiting_;
  mutable Mutex mutex_;
  ConditionVariable changed_;
  TurnQueue tasks_ HOMING_GUARDED_BY(mutex_);
  bool stopping_ HOMING_GUARDED_BY(mutex_) = false;
  bool stopped_ HOMING_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};

// Tasks of one stream: one at a time, in the order posted, also across pools. Thread-safe.
class Strand : public std::enable_shared_from_this<Strand> {
 public:
  // `pool` must outlive all tasks. `caller`: who takes turns with others in the pools.
  explicit Strand(WorkerPool* pool, std::string caller = "")
      : pool_(pool), caller_(std::move(caller)) {}

  void Post(WorkerPool::Task task) { PostTo(pool_, std::move(task)); }
  // Runs this task in another pool, which must outlive all tasks too.
  void PostTo(WorkerPool* pool, WorkerPool::Task task);
  // Runs the task on the caller's thread before it returns, unless another task of this strand runs
  // or waits.
  void RunOrPost(WorkerPool::Task task);

 private:
  struct Entry {
    WorkerPool* pool;
    WorkerPool::Task task;
  };

  void RunSome(WorkerPool* pool);
  void ScheduleOn(WorkerPool* pool);
  // Schedules the next task, if there is one.
  void ScheduleRest();

  WorkerPool* const pool_;
  const std::string caller_;
  Mutex mutex_;
  // A list and not a deque: an empty deque takes 600 bytes, and there are many strands.
  std::list<Entry> tasks_ HOMING_GUARDED_BY(mutex_);
  bool scheduled_ HOMING_GUARDED_BY(mutex_) = false;
};

}  // namespace homing::server

#endif  // SERVER_BASE_WORKER_POOL_H_
