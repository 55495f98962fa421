// Whether the wall clock can be trusted.
#ifndef SERVER_CLOCK_WATCH_H_
#define SERVER_CLOCK_WATCH_H_

#include <chrono>
#include <cstdint>
#include <vector>

namespace homing::server {

// A machine without a hardware clock starts in 1970 and learns the time later; journeys that it
// made before then look old at once. One with a wrong clock may start in a later year: then all
// journeys look old, until the clock is corrected. Not thread-safe.
class ClockWatch {
 public:
  // No journey of this program is older. Nanoseconds since the epoch (the start of 2026).
  static constexpr std::int64_t kEarliestNs = 1'767'225'600'000'000'000;

  // Returns the earliest creation time whose age can be trusted, nanoseconds since the epoch; in
  // the first ten minutes, and in those after a jump ahead was taken back, there is none. Call it
  // periodically, with both clocks read at the same moment.
  std::int64_t TrustedSince(std::int64_t wall_ns, std::chrono::steady_clock::time_point steady);

 private:
  // As they were before a jump ahead.
  struct Jump {
    std::chrono::nanoseconds offset;
    std::int64_t since_ns;
  };

  bool begun_ = false;
  // Of the wall clock against the steady one.
  std::chrono::nanoseconds offset_{};
  // Those that were not taken back; each began ahead of the one before it.
  std::vector<Jump> jumps_;
  std::chrono::steady_clock::time_point started_;
  std::int64_t since_ns_ = kEarliestNs;
};

}  // namespace homing::server

#endif  // SERVER_CLOCK_WATCH_H_
