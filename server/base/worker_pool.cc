#include "server/base/worker_pool.h"

#include <algorithm>
#include <chrono>
#include <opencv2/core/utility.hpp>
#include <utility>

#include "homing/base/mutex.h"

namespace homing::server {
namespace {

// A worker takes another stream after this many tasks of one, or after this time: a stream that
// sends much again after a broken link does not hold up those that send one observation at a time.
constexpr int kTasksATurn = 8;
constexpr std::chrono::milliseconds kTurn{2};

void RunOpenCvSingleThreaded() {
  static std::once_flag once;
  std::call_once(once, [] { cv::setNumThreads(0); });
}

}  // namespace

WorkerPool::WorkerPool(int workers, int max_waiting)
    : max_waiting_(static_cast<std::size_t>(std::max(max_waiting, 1))) {
  RunOpenCvSingleThreaded();
  for (int i = 0; i < std::max(workers, 1); ++i) {
    threads_.emplace_back([this] { Work(); });
  }
}

void WorkerPool::Stop() {
  {
    const MutexLock lock(mutex_);
    stopping_ = true;
  }
  changed_.NotifyAll();
  for (std::thread& thread : threads_) {
    thread.join();
  }
  threads_.clear();
  TurnQueue left;
  {
    const MutexLock lock(mutex_);
    stopped_ = true;
    std::swap(left, tasks_);
  }
  // Another pool's tasks may have added them after the last thread had ended.
  while (!left.empty()) left.Take()();
}

bool WorkerPool::TryRun(Task task, const std::string& caller) {
  {
    const MutexLock lock(mutex_);
    if (tasks_.size() >= max_waiting_ && tasks_.HasTaskOf(caller)) {
      return false;
    }
    tasks_.Add(caller, std::move(task));
  }
  changed_.NotifyOne();
  return true;
}

void WorkerPool::Run(Task task, const std::string& caller) {
  {
    MutexLock lock(mutex_);
    if (stopped_) {
      lock.Unlock();
      task();
      return;
    }
    tasks_.Add(caller, std::move(task));
  }
  changed_.NotifyOne();
}

std::size_t WorkerPool::waiting() const {
  const MutexLock lock(mutex_);
  return tasks_.size();
}

void WorkerPool::Work() {
  MutexLock lock(mutex_);
  while (true) {
    while (!stopping_ && tasks_.empty()) changed_.Wait(mutex_);
    if (tasks_.empty()) {
      return;
    }
    Task task = tasks_.Take();
    lock.Unlock();
    task();
    task = nullptr;
    lock.Lock();
  }
}

void Strand::PostTo(WorkerPool* pool, WorkerPool::Task task) {
  {
    const MutexLock lock(mutex_);
    tasks_.push_back({pool, std::move(task)});
    if (scheduled_) {
      return;
    }
    scheduled_ = true;
  }
  ScheduleOn(pool);
}

void Strand::RunOrPost(WorkerPool::Task task) {
  {
    const MutexLock lock(mutex_);
    if (scheduled_) {
      tasks_.push_back({pool_, std::move(task)});
      return;
    }
    scheduled_ = true;
  }
  task();
  ScheduleRest();
}

void Strand::ScheduleOn(WorkerPool* pool) {
  pool->Run([self = shared_from_this(), pool] { self->RunSome(pool); }, caller_);
}

void Strand::ScheduleRest() {
  WorkerPool* next = nullptr;
  {
    const MutexLock lock(mutex_);
    scheduled_ = !tasks_.empty();
    if (!scheduled_) {
      return;
    }
    next = tasks_.front().pool;
  }
  ScheduleOn(next);
}

void Strand::RunSome(WorkerPool* pool) {
  const auto end = std::chrono::steady_clock::now() + kTurn;
  for (int run = 0; run < kTasksATurn; ++run) {
    WorkerPool::Task task;
    {
      const MutexLock lock(mutex_);
      if (tasks_.empty() || tasks_.front().pool != pool) {
        break;
      }
      task = std::move(tasks_.front().task);
      tasks_.pop_front();
    }
    task();
    if (std::chrono::steady_clock::now() >= end) {
      break;
    }
  }
  ScheduleRest();
}

}  // namespace homing::server
