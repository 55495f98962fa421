// Whether the wall clock can be trusted.
#ifndef SERVER_CLOCK_WATCH_H_
#define SERVER_CLOCK_WATCH_H_

#include <chrono>
#include <cstdint>

namespace homing::server {

// A machine without a hardware clock starts in 1970 and learns the time later; journeys that it
// made before then look old at once. One with a wrong clock may start in a later year: then all
// journeys look old, until the clock is corrected. Not thread-safe.
class ClockWatch {
 public:
  // No journey of this program is older. Nanoseconds since the epoch (the start of 2026).
  static constexpr std::int64_t kEarliestNs = 1'767'225'600'000'000'000;

  // Returns the earliest creation time whose age can be trusted, nanoseconds since the epoch; in
  // the first ten minutes there is none. Call it periodically, with both clocks read at the same
  // moment.
  std::int64_t TrustedSince(std::int64_t wall_ns, std::chrono::steady_clock::time_point steady);

 private:
  bool begun_ = false;
  std::int64_t wall_ns_ = 0;
  std::chrono::steady_clock::time_point steady_;
  std::chrono::steady_clock::time_point started_;
  std::int64_t since_ns_ = kEarliestNs;
};

}  // namespace homing::server

#endif  // SERVER_CLOCK_WATCH_H_
