// Limits failed logins for each address, so that guessing does not fill the log. A login that
// succeeds is never refused: others may share its address, and a secret of 256 random bits cannot
// be guessed.
#ifndef SERVER_HTTP_LOGIN_LIMIT_H_
#define SERVER_HTTP_LOGIN_LIMIT_H_

#include <chrono>
#include <cstddef>
#include <map>
#include <string>

#include "homing/base/mutex.h"

namespace homing::server {

// Thread-safe.
class LoginLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr int kMostFailures = 10;
  static constexpr std::chrono::minutes kPeriod{1};

  // Counts a failure. False: `address` had kMostFailures before it within kPeriod.
  bool MayFail(const std::string& address, Time now);

 private:
  struct Failures {
    int count = 0;
    Time begin;
  };
  // More addresses than this share one limit.
  static constexpr std::size_t kMostAddresses = 10'000;

  std::map<std::string, Failures>::iterator Find(const std::string& address, Time now)
      HOMING_REQUIRES(mutex_);

  Mutex mutex_;
  // Failures of the last kPeriod, by address.
  std::map<std::string, Failures> failures_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::server

#endif  // SERVER_HTTP_LOGIN_LIMIT_H_
