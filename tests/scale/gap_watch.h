// The longest time for which a robot had no answer, by what happened then.
#ifndef TESTS_SCALE_GAP_WATCH_H_
#define TESTS_SCALE_GAP_WATCH_H_

#include <chrono>
#include <iostream>
#include <map>
#include <string>

#include "homing/base/mutex.h"

namespace homing::scale {

// Thread-safe.
class GapWatch {
 public:
  using Clock = std::chrono::steady_clock;

  // What happens from now on.
  void SetEvent(const std::string& event) {
    const MutexLock lock(mutex_);
    event_ = event;
  }
  // A robot has an answer.
  void Answered(int robot) {
    const MutexLock lock(mutex_);
    const auto now = Clock::now();
    const auto [last, is_new] = last_.try_emplace(robot, now);
    if (!is_new && !event_.empty() && now - last->second > longest_[event_]) {
      longest_[event_] = now - last->second;
      if (longest_[event_] > std::chrono::seconds(4)) {
        std::cerr << event_ << ": " << std::chrono::duration<double>(longest_[event_]).count()
                  << " s without an answer for robot " << robot << '\n';
      }
    }
    last->second = now;
  }
  double LongestSeconds(const std::string& event) {
    const MutexLock lock(mutex_);
    return std::chrono::duration<double>(longest_[event]).count();
  }

 private:
  Mutex mutex_;
  std::string event_ HOMING_GUARDED_BY(mutex_);
  std::map<int, Clock::time_point> last_ HOMING_GUARDED_BY(mutex_);
  std::map<std::string, Clock::duration> longest_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::scale

#endif  // TESTS_SCALE_GAP_WATCH_H_
