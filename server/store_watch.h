// Watches whether the store accepts writes, and reports it to the health service.
#ifndef SERVER_STORE_WATCH_H_
#define SERVER_STORE_WATCH_H_

#include <chrono>
#include <functional>

#include "server/base/periodic_thread.h"
#include "storage/journey_store.h"

namespace homing::server {

// While writes fail, it tries one each second: robots do not call a server that is not serving, so
// nothing else would show that writes work again. One thread does all its work.
class StoreWatch {
 public:
  // Called on the watch's thread after a change; true: writes work.
  using OnChange = std::function<void(bool)>;

  // `store` must outlive the watch. The initial state is: writes work.
  // No call follows the destructor.
  StoreWatch(storage::JourneyStore* store, OnChange on_change);

 private:
  // Looks once, and returns the time until the next look.
  std::chrono::milliseconds Look();

  storage::JourneyStore* const store_;
  const OnChange on_change_;
  // Used by the thread alone.
  bool well_ = true;
  PeriodicThread thread_;
};

}  // namespace homing::server

#endif  // SERVER_STORE_WATCH_H_
