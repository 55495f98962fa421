// Periodic work beside the calls: reloads files, closes idle streams, deletes expired journeys, and
// warns of certificates that end soon.
#ifndef SERVER_HOUSEKEEPING_H_
#define SERVER_HOUSEKEEPING_H_

#include <chrono>
#include <functional>
#include <thread>

#include "homing/base/mutex.h"
#include "server/access/certificate_expiry.h"
#include "server/clock_watch.h"
#include "server/rpc/service_core.h"

namespace homing::server {

// One thread; the destructor waits for the current round.
class Housekeeping {
 public:
  // `core` must outlive it. `reload_more` is called at each reload.
  Housekeeping(ServiceCore* core, std::chrono::seconds reload_every,
               const CertificateFiles& certificates,
               std::function<absl::Status()> reload_more = nullptr);
  ~Housekeeping();
  // Reads certificates, tokens and roles again. Thread-safe.
  void Reload();
  Housekeeping(const Housekeeping&) = delete;
  Housekeeping& operator=(const Housekeeping&) = delete;

 private:
  void Run();
  void DeleteExpired();
  void WarnOfExpiry();
  void CountJourneys();

  // Used by the thread alone.
  ClockWatch clock_;

  ServiceCore* const core_;
  const std::chrono::seconds reload_every_;
  const CertificateFiles certificates_;
  const std::function<absl::Status()> reload_more_;
  Mutex mutex_;
  ConditionVariable stop_;
  bool stopping_ HOMING_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace homing::server

#endif  // SERVER_HOUSEKEEPING_H_
