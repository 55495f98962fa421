// Whether the wall clock can be trusted.
#ifndef SERVER_CLOCK_WATCH_H_
#define SERVER_CLOCK_WATCH_H_

#include <chrono>
#include <cstdint>

namespace homing::server {

// A machine without a clock begins in 1970 and learns the time later: what it made before then
// looks old at once. Not thread-safe.
class ClockWatch {
 public:
  // No journey of this program was made before; nanoseconds since the epoch (the start of 2026).
  static constexpr std::int64_t kEarliestNs = 1'767'225'600'000'000'000;

  // What was made from here on has an age that can be trusted, as far as is known at `wall_ns`;
  // both clocks are read together, again and again.
  std::int64_t TrustedSince(std::int64_t wall_ns, std::chrono::steady_clock::time_point steady);

 private:
  bool begun_ = false;
  std::int64_t wall_ns_ = 0;
  std::chrono::steady_clock::time_point steady_;
  std::int64_t since_ns_ = kEarliestNs;
};

}  // namespace homing::server

#endif  // SERVER_CLOCK_WATCH_H_
