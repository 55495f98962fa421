// The latencies of a load and their percentiles.
#ifndef CLIENT_BENCH_LATENCIES_H_
#define CLIENT_BENCH_LATENCIES_H_

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace homing::client {

// Keeps each latency, up to 71 minutes, as four bytes of microseconds. Not thread-safe.
class Latencies {
 public:
  // A negative latency counts as 0.
  void Add(std::chrono::nanoseconds latency) {
    const std::int64_t us = latency.count() / 1000;
    us_.push_back(static_cast<std::uint32_t>(
        std::clamp<std::int64_t>(us, 0, std::numeric_limits<std::uint32_t>::max())));
  }
  void Add(const Latencies& other) { us_.insert(us_.end(), other.us_.begin(), other.us_.end()); }
  std::size_t count() const { return us_.size(); }
  double max_ms() const { return PercentileMs(1); }
  // The least latency, ms, that at least this fraction of the latencies does not exceed; 0 if there
  // are none. REQUIRES: 0 to 1.
  double PercentileMs(double fraction) const {
    if (us_.empty()) return 0;
    std::vector<std::uint32_t> us = us_;
    const double rank = std::ceil(fraction * static_cast<double>(us.size()));
    const auto at = us.begin() + std::max<std::ptrdiff_t>(0, static_cast<std::ptrdiff_t>(rank) - 1);
    std::nth_element(us.begin(), at, us.end());
    return *at * 1e-3;
  }

 private:
  std::vector<std::uint32_t> us_;
};

}  // namespace homing::client

#endif  // CLIENT_BENCH_LATENCIES_H_
