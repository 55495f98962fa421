// Repeats work on its own thread.
#ifndef SERVER_BASE_PERIODIC_THREAD_H_
#define SERVER_BASE_PERIODIC_THREAD_H_

#include <chrono>
#include <functional>
#include <thread>
#include <utility>

#include "homing/base/mutex.h"

namespace homing::server {

// Calls `round` at once, and again after the pause that each call returns. The destructor waits for
// the current call and cuts the pause short; no call follows. Declare it behind all that `round`
// uses.
class PeriodicThread {
 public:
  using Round = std::function<std::chrono::milliseconds()>;
  explicit PeriodicThread(Round round) : round_(std::move(round)), thread_([this] { Run(); }) {}
  ~PeriodicThread() {
    {
      const MutexLock lock(mutex_);
      stopping_ = true;
    }
    stop_.NotifyAll();
    thread_.join();
  }
  PeriodicThread(const PeriodicThread&) = delete;
  PeriodicThread& operator=(const PeriodicThread&) = delete;

 private:
  void Run() {
    while (true) {
      const std::chrono::milliseconds pause = round_();
      const auto next = std::chrono::steady_clock::now() + pause;
      const MutexLock lock(mutex_);
      while (!stopping_ && stop_.WaitUntil(mutex_, next)) {
      }
      if (stopping_) return;
    }
  }

  const Round round_;
  Mutex mutex_;
  ConditionVariable stop_;
  bool stopping_ HOMING_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace homing::server

#endif  // SERVER_BASE_PERIODIC_THREAD_H_
