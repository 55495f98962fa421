// The longest time for which a robot had no answer, by what happened then.
#ifndef TESTS_SCALE_GAP_WATCH_H_
#define TESTS_SCALE_GAP_WATCH_H_

#include <chrono>
#include <iostream>
#include <map>
#include <string>
#include <utility>
#include <vector>

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
    begin_ = Clock::now();
  }
  // A robot has an answer.
  void Answered(int robot) {
    const MutexLock lock(mutex_);
    const auto now = Clock::now();
    const auto [found, is_new] = robots_.try_emplace(robot, Robot{now, {}});
    Robot& seen = found->second;
    if (!is_new && !event_.empty() && now - seen.last > longest_[event_]) {
      longest_[event_] = now - seen.last;
      if (longest_[event_] > kShown) Show(robot, seen, now);
    }
    seen.last = now;
    seen.steps.clear();
  }
  // What a robot does between two answers. Shown if they are far apart.
  void Noted(int robot, const std::string& step) {
    const MutexLock lock(mutex_);
    const auto found = robots_.find(robot);
    if (found != robots_.end()) found->second.steps.emplace_back(Clock::now(), step);
  }
  double LongestSeconds(const std::string& event) {
    const MutexLock lock(mutex_);
    return std::chrono::duration<double>(longest_[event]).count();
  }

 private:
  struct Robot {
    // Its last answer.
    Clock::time_point last;
    // Since then.
    std::vector<std::pair<Clock::time_point, std::string>> steps;
  };

  static constexpr std::chrono::seconds kShown{3};

  static double Seconds(Clock::duration time) {
    return std::chrono::duration<double>(time).count();
  }
  // Times are seconds since the event began.
  void Show(int number, const Robot& robot, Clock::time_point now) HOMING_REQUIRES(mutex_) {
    std::cerr << event_ << ": " << Seconds(now - robot.last) << " s without an answer for robot "
              << number << ", from " << Seconds(robot.last - begin_) << '\n';
    for (const auto& [time, step] : robot.steps) {
      std::cerr << "  " << Seconds(time - begin_) << ' ' << step << '\n';
    }
  }

  Mutex mutex_;
  std::string event_ HOMING_GUARDED_BY(mutex_);
  Clock::time_point begin_ HOMING_GUARDED_BY(mutex_);
  std::map<int, Robot> robots_ HOMING_GUARDED_BY(mutex_);
  std::map<std::string, Clock::duration> longest_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::scale

#endif  // TESTS_SCALE_GAP_WATCH_H_
