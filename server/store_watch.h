// Watches whether the store accepts writes, and reports it to the health service.
#ifndef SERVER_STORE_WATCH_H_
#define SERVER_STORE_WATCH_H_

#include <functional>
#include <thread>

#include "homing/base/mutex.h"
#include "storage/journey_store.h"

namespace homing::server {

// While writes fail, it tries one each second: robots do not call a server that is not serving, so
// nothing else would show that writes work again.
class StoreWatch {
 public:
  // Called on the watch's thread after a change; true: writes work.
  using OnChange = std::function<void(bool)>;

  // `store` must outlive the watch. The initial state is: writes work.
  StoreWatch(storage::JourneyStore* store, OnChange on_change);
  // No call follows the destructor.
  ~StoreWatch();

 private:
  void Run();
  // False: stopped meanwhile.
  bool Sleep(std::chrono::milliseconds time);

  storage::JourneyStore* const store_;
  const OnChange on_change_;
  Mutex mutex_;
  ConditionVariable stopped_;
  bool stopping_ HOMING_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace homing::server

#endif  // SERVER_STORE_WATCH_H_
