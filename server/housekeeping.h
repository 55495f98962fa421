// What is done now and then beside the calls: files read again, idle streams closed, journeys past
// their time deleted. Source: own design.
#ifndef SERVER_HOUSEKEEPING_H_
#define SERVER_HOUSEKEEPING_H_

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "server/clock_watch.h"
#include "server/rpc/service_core.h"

namespace homing::server {

// One thread. Stops at its end, at the latest after the round under way.
class Housekeeping {
 public:
  // `core` must outlive it.
  Housekeeping(ServiceCore* core, std::chrono::seconds reload_every);
  ~Housekeeping();
  // Reads certificates, tokens and roles again. Thread-safe.
  void Reload();
  Housekeeping(const Housekeeping&) = delete;
  Housekeeping& operator=(const Housekeeping&) = delete;

 private:
  void Run();
  void DeleteExpired();

  // Used by the thread alone.
  ClockWatch clock_;

  ServiceCore* const core_;
  const std::chrono::seconds reload_every_;
  std::mutex mutex_;
  std::condition_variable stop_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace homing::server

#endif  // SERVER_HOUSEKEEPING_H_
