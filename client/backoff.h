// Exponential waiting times between attempts. Source: own design.
#ifndef CLIENT_BACKOFF_H_
#define CLIENT_BACKOFF_H_

#include <chrono>
#include <random>
#include <stop_token>

namespace homing::client {

struct BackoffOptions {
  // First wait and longest wait. A server that is back is found within a second.
  std::chrono::milliseconds initial{100};
  std::chrono::milliseconds longest{700};
  // Growth from one wait to the next. [1, 10].
  double factor = 1.7;
  // Each wait is shortened by up to this share, so that a fleet does not come back as one. [0, 1].
  double jitter = 0.3;
};

// Not thread-safe.
class Backoff {
 public:
  explicit Backoff(const BackoffOptions& options = {});
  // The next wait.
  std::chrono::milliseconds Next();
  // After success: begins again with the first wait.
  void Reset() { current_ = options_.initial; }

 private:
  BackoffOptions options_;
  std::chrono::milliseconds current_;
  std::minstd_rand random_;
};

// Sleeps; false if stopped meanwhile.
bool SleepFor(std::chrono::milliseconds duration, const std::stop_token& stop);

}  // namespace homing::client

#endif  // CLIENT_BACKOFF_H_
