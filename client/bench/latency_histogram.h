// Counts latencies in buckets of equal relative width. Source: after Tene's HDR histogram.
#ifndef CLIENT_BENCH_LATENCY_HISTOGRAM_H_
#define CLIENT_BENCH_LATENCY_HISTOGRAM_H_

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace homing::client {

// Microseconds up to an hour, to within 1/64 of their value. Not thread-safe.
class LatencyHistogram {
 public:
  void Add(std::chrono::nanoseconds latency);
  void Add(const LatencyHistogram& other);
  std::uint64_t count() const { return count_; }
  double max_ms() const { return static_cast<double>(max_us_) * 1e-3; }
  // The latency, ms, that at least this fraction of the latencies does not exceed; 0 if there are
  // none. REQUIRES: 0 to 1.
  double PercentileMs(double share) const;

 private:
  static constexpr int kSubBits = 6;
  static constexpr std::uint64_t kSub = std::uint64_t{1} << kSubBits;
  static constexpr std::size_t kBuckets = kSub * 28;

  static std::size_t BucketOf(std::uint64_t us);
  // The greatest value that a bucket holds.
  static std::uint64_t HighestIn(std::size_t bucket);

  std::array<std::uint64_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0;
  std::uint64_t max_us_ = 0;
};

}  // namespace homing::client

#endif  // CLIENT_BENCH_LATENCY_HISTOGRAM_H_
