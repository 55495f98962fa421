#include "client/backoff.h"

#include <algorithm>

#include "homing/base/mutex.h"

namespace homing::client {

Backoff::Backoff(const BackoffOptions& options)
    : options_(options), current_(options.initial), random_(std::random_device{}()) {}

std::chrono::milliseconds Backoff::Next() {
  using Milliseconds = std::chrono::duration<double, std::milli>;
  const double share = std::uniform_real_distribution<double>(0, options_.jitter)(random_);
  const auto wait =
      std::chrono::duration_cast<std::chrono::milliseconds>(Milliseconds(current_) * (1 - share));
  current_ = std::min(options_.longest, std::chrono::duration_cast<std::chrono::milliseconds>(
                                            Milliseconds(current_) * options_.factor));
  return wait;
}

bool SleepFor(std::chrono::milliseconds duration, const std::stop_token& stop) {
  Mutex mutex;
  ConditionVariable wake;
  const std::stop_callback on_stop(stop, [&] {
    const MutexLock lock(mutex);
    wake.NotifyAll();
  });
  const auto end = std::chrono::steady_clock::now() + duration;
  const MutexLock lock(mutex);
  while (!stop.stop_requested() && wake.WaitUntil(mutex, end)) {
  }
  return !stop.stop_requested();
}

}  // namespace homing::client
