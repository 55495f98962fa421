// Watches whether the store takes writes, so that health can say so.
#ifndef SERVER_STORE_WATCH_H_
#define SERVER_STORE_WATCH_H_

#include <functional>
#include <thread>

#include "homing/base/mutex.h"
#include "storage/journey_store.h"

namespace homing::server {

// While writes fail, tries one a second: the server comes back by itself when there is room again,
// though no robot calls a server that is not serving.
class StoreWatch {
 public:
  // Called on a thread of the watch when it changes; true: writes work.
  using OnChange = std::function<void(bool)>;

  // `store` must outlive the watch. Writes are taken to work at first.
  StoreWatch(storage::JourneyStore* store, OnChange on_change);
  // No call comes after it.
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
