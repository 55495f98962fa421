#include "client/bench/latency_histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace homing::client {

std::size_t LatencyHistogram::BucketOf(std::uint64_t us) {
  if (us < kSub) {
    return us;
  }
  // Octaves of 64 buckets each, the first of single microseconds.
  const int octave = static_cast<int>(std::bit_width(us)) - 1 - kSubBits;
  const std::uint64_t within = (us >> octave) - kSub;
  return std::min(kBuckets - 1, static_cast<std::size_t>((octave + 1)) * kSub + within);
}

std::uint64_t LatencyHistogram::HighestIn(std::size_t bucket) {
  if (bucket < kSub) {
    return bucket;
  }
  const std::uint64_t octave = bucket / kSub - 1;
  return ((bucket % kSub + kSub + 1) << octave) - 1;
}

void LatencyHistogram::Add(std::chrono::nanoseconds latency) {
  const std::int64_t us = std::max<std::int64_t>(0, latency.count() / 1000);
  ++buckets_[BucketOf(static_cast<std::uint64_t>(us))];
  ++count_;
  max_us_ = std::max(max_us_, static_cast<std::uint64_t>(us));
}

void LatencyHistogram::Add(const LatencyHistogram& other) {
  for (std::size_t i = 0; i < kBuckets; ++i) {
    buckets_[i] += other.buckets_[i];
  }
  count_ += other.count_;
  max_us_ = std::max(max_us_, other.max_us_);
}

double LatencyHistogram::PercentileMs(double share) const {
  const auto rank = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < kBuckets; ++i) {
    below += buckets_[i];
    if (below >= std::max<std::uint64_t>(rank, 1)) {
      return static_cast<double>(std::min(HighestIn(i), max_us_)) * 1e-3;
    }
  }
  return 0;
}

}  // namespace homing::client
