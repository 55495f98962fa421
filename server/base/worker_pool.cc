#include "server/base/worker_pool.h"

#include <algorithm>
#include <opencv2/core/utility.hpp>
#include <utility>

#include "homing/base/mutex.h"

namespace homing::server {
namespace {

// A worker runs at most this many tasks of one stream before it takes another stream.
constexpr int kTasksATurn = 8;

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

WorkerPool::~WorkerPool() {
  {
    const MutexLock lock(mutex_);
    stopping_ = true;
  }
  changed_.NotifyAll();
  for (std::thread& thread : threads_) {
    thread.join();
  }
}

bool WorkerPool::TryRun(Task task) {
  {
    const MutexLock lock(mutex_);
    if (tasks_.size() >= max_waiting_) {
      return false;
    }
    tasks_.push_back(std::move(task));
  }
  changed_.NotifyOne();
  return true;
}

void WorkerPool::Run(Task task) {
  {
    const MutexLock lock(mutex_);
    tasks_.push_back(std::move(task));
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
    Task task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.Unlock();
    task();
    task = nullptr;
    lock.Lock();
  }
}

void Strand::Post(WorkerPool::Task task) {
  {
    const MutexLock lock(mutex_);
    tasks_.push_back(std::move(task));
    if (scheduled_) {
      return;
    }
    scheduled_ = true;
  }
  ScheduleRest();
}

void Strand::RunOrPost(WorkerPool::Task task) {
  {
    const MutexLock lock(mutex_);
    if (scheduled_) {
      tasks_.push_back(std::move(task));
      return;
    }
    scheduled_ = true;
  }
  task();
  {
    const MutexLock lock(mutex_);
    scheduled_ = !tasks_.empty();
    if (!scheduled_) {
      return;
    }
  }
  ScheduleRest();
}

void Strand::ScheduleRest() {
  pool_->Run([self = shared_from_this()] { self->RunSome(); });
}

void Strand::RunSome() {
  for (int run = 0; run < kTasksATurn; ++run) {
    WorkerPool::Task task;
    {
      const MutexLock lock(mutex_);
      if (tasks_.empty()) {
        scheduled_ = false;
        return;
      }
      task = std::move(tasks_.front());
      tasks_.pop_front();
    }
    task();
  }
  ScheduleRest();
}

}  // namespace homing::server
