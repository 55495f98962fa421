// What is done now and then beside the calls: files read again, idle streams closed, journeys past
// their time deleted. Source: own design.
#ifndef SERVER_HOUSEKEEPING_H_
#define SERVER_HOUSEKEEPING_H_

#include <chrono>
#include <thread>

#include "homing/base/mutex.h"
#include "server/rpc/service_core.h"

namespace homing::server {

// One thread. Stops at its end, at the latest after the round under way.
class Housekeeping {
 public:
  // `core` must outlive it.
  Housekeeping(ServiceCore* core, std::chrono::seconds reload_every);
  ~Housekeeping();
  Housekeeping(const Housekeeping&) = delete;
  Housekeeping& operator=(const Housekeeping&) = delete;

 private:
  void Run();
  void Reload();
  void DeleteExpired();

  ServiceCore* const core_;
  const std::chrono::seconds reload_every_;
  Mutex mutex_;
  ConditionVariable stop_;
  bool stopping_ HOMING_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace homing::server

#endif  // SERVER_HOUSEKEEPING_H_
