#include "server/admission/rate_limiter.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "homing/base/mutex.h"
#include "server/base/error_reason.h"

namespace homing::server {
namespace {

constexpr double kBurstSeconds = 2;

}  // namespace

double RateLimiter::TokensAt(const Bucket& bucket, TimePoint now) const {
  const double elapsed_s = std::chrono::duration<double>(now - bucket.at).count();
  return std::min(rate_ * kBurstSeconds, bucket.tokens + std::max(elapsed_s, 0.0) * rate_);
}

void RateLimiter::ForgetFull(TimePoint now) {
  if (buckets_.size() < next_sweep_) {
    return;
  }
  std::erase_if(buckets_, [&](const auto& entry) {
    return TokensAt(entry.second, now) >= rate_ * kBurstSeconds;
  });
  next_sweep_ = std::max<std::size_t>(1024, 2 * buckets_.size());
}

absl::Status RateLimiter::Take(const std::string& key, TimePoint now) {
  if (rate_ <= 0) {
    return absl::OkStatus();
  }
  const MutexLock lock(mutex_);
  ForgetFull(now);
  const auto [found, is_new] = buckets_.try_emplace(key, Bucket{rate_ * kBurstSeconds, now});
  Bucket& bucket = found->second;
  bucket.tokens = TokensAt(bucket, now);
  bucket.at = now;
  if (bucket.tokens >= 1) {
    bucket.tokens -= 1;
    return absl::OkStatus();
  }
  const auto wait_ms = static_cast<std::int64_t>(std::ceil((1 - bucket.tokens) / rate_ * 1000));
  return WithReason(
      absl::ResourceExhaustedError(absl::StrCat("observations come faster than max-robot-rate, ",
                                                rate_, " a second; wait ", wait_ms, " ms")),
      {"RATE", {{kRetryAfterMs, absl::StrCat(wait_ms)}}});
}

}  // namespace homing::server
