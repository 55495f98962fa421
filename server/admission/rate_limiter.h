// A token bucket for each robot.
#ifndef SERVER_ADMISSION_RATE_LIMITER_H_
#define SERVER_ADMISSION_RATE_LIMITER_H_

#include <map>
#include <string>

#include "absl/status/status.h"
#include "homing/base/mutex.h"
#include "server/catalog/writer_lease.h"

namespace homing::server {

// Thread-safe. Full buckets are dropped.
class RateLimiter {
 public:
  // Each second adds `per_second` tokens, up to twice as many in total; 0: no limit.
  explicit RateLimiter(int per_second) : rate_(per_second) {}

  // Takes one token. RESOURCE_EXHAUSTED with the time until the next one.
  absl::Status Take(const std::string& key, TimePoint now);

 private:
  struct Bucket {
    double tokens = 0;
    TimePoint at{};
  };
  double TokensAt(const Bucket& bucket, TimePoint now) const;
  void ForgetFull(TimePoint now) HOMING_REQUIRES(mutex_);

  const double rate_;
  Mutex mutex_;
  std::map<std::string, Bucket> buckets_ HOMING_GUARDED_BY(mutex_);
  std::size_t next_sweep_ HOMING_GUARDED_BY(mutex_) = 1024;
};

}  // namespace homing::server

#endif  // SERVER_ADMISSION_RATE_LIMITER_H_
