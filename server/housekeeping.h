// Periodic work beside the calls: reloads files, closes idle streams, deletes expired journeys, and
// warns of certificates that end soon.
#ifndef SERVER_HOUSEKEEPING_H_
#define SERVER_HOUSEKEEPING_H_

#include <chrono>
#include <cstdint>
#include <functional>

#include "server/access/certificate_expiry.h"
#include "server/base/periodic_thread.h"
#include "server/clock_watch.h"
#include "server/rpc/service_core.h"

namespace homing::server {

// Works on one thread; the destructor waits for the current round.
class Housekeeping {
 public:
  // `core` must outlive it. `reload_more` is called at each reload.
  Housekeeping(ServiceCore* core, std::chrono::seconds reload_every,
               const CertificateFiles& certificates,
               std::function<absl::Status()> reload_more = nullptr);
  // Reads certificates, tokens and roles again. Thread-safe.
  void Reload(AccessControl::Reading reading);

 private:
  // Does all work whose time has come; returns the time until the next round.
  std::chrono::milliseconds Work();
  void DeleteExpired();
  void WarnOfExpiry();
  void CountJourneys();

  // The thread alone uses these two.
  ClockWatch clock_;
  std::int64_t round_ = 0;

  ServiceCore* const core_;
  const std::chrono::seconds reload_every_;
  const CertificateFiles certificates_;
  const std::function<absl::Status()> reload_more_;
  PeriodicThread thread_;
};

}  // namespace homing::server

#endif  // SERVER_HOUSEKEEPING_H_
