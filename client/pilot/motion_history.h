// The actuators' motion in the last seconds, by the commands.
#ifndef CLIENT_PILOT_MOTION_HISTORY_H_
#define CLIENT_PILOT_MOTION_HISTORY_H_

#include <algorithm>
#include <cstddef>
#include <deque>

namespace homing::client {

// Not thread-safe.
class MotionHistory {
 public:
  // The motion from `time_s` on. Forgets what is older than `memory_s`. REQUIRES: times ascend.
  void Add(double time_s, double speed_mps, double turn_rate, double memory_s) {
    past_.push_back({time_s, speed_mps, turn_rate});
    while (past_.front().time_s < time_s - memory_s) past_.pop_front();
  }

  // Calls visit(speed_mps, turn_rate, seconds) for each stretch between two times, in order.
  template <typename Visit>
  void Between(double from_s, double to_s, const Visit& visit) const {
    for (std::size_t i = 0; i < past_.size(); ++i) {
      const double begin = std::max(from_s, past_[i].time_s);
      const double end = std::min(to_s, i + 1 < past_.size() ? past_[i + 1].time_s : to_s);
      if (end > begin) visit(past_[i].speed_mps, past_[i].turn_rate, end - begin);
    }
  }

  // Turn between two times, rad to the left.
  double Turned(double from_s, double to_s) const {
    double turned = 0;
    Between(from_s, to_s, [&](double /*speed_mps*/, double turn_rate, double seconds) {
      turned += turn_rate * seconds;
    });
    return turned;
  }

 private:
  struct Motion {
    double time_s = 0;
    double speed_mps = 0;
    double turn_rate = 0;
  };
  std::deque<Motion> past_;
};

}  // namespace homing::client

#endif  // CLIENT_PILOT_MOTION_HISTORY_H_
