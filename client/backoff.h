// Exponential waiting times between attempts.
#ifndef CLIENT_BACKOFF_H_
#define CLIENT_BACKOFF_H_

#include <chrono>
#include <random>
#include <stop_token>

namespace homing::client {

struct BackoffOptions {
  // The first and the longest wait: a client finds a restarted server within a second.
  std::chrono::milliseconds initial{100};
  std::chrono::milliseconds longest{700};
  // Growth from one wait to the next. [1, 10].
  double factor = 1.7;
  // Each wait is shortened by a random part of up to this fraction, so that the robots of a fleet
  // do not return at the same time. [0, 1].
  double jitter = 0.3;
};

// Not thread-safe.
class Backoff {
 public:
  explicit Backoff(const BackoffOptions& options = {});
  // Returns the next wait, and lengthens the one after it.
  std::chrono::milliseconds Next();
  // Call it after a success: restarts with the first wait.
  void Reset() { current_ = options_.initial; }

 private:
  BackoffOptions options_;
  std::chrono::milliseconds current_;
  std::minstd_rand random_;
};

// Sleeps for `duration`; false if stopped meanwhile.
bool SleepFor(std::chrono::milliseconds duration, const std::stop_token& stop);

}  // namespace homing::client

#endif  // CLIENT_BACKOFF_H_
