// Journeys whose map was found damaged.
#ifndef SERVER_CATALOG_DAMAGED_JOURNEYS_H_
#define SERVER_CATALOG_DAMAGED_JOURNEYS_H_

#include <spdlog/spdlog.h>

#include <set>
#include <string>

#include "absl/status/status.h"
#include "homing/base/mutex.h"

namespace homing::server {

// Thread-safe.
class DamagedJourneys {
 public:
  // Logs each journey once.
  void Add(const std::string& name, const absl::Status& why) {
    const MutexLock lock(mutex_);
    if (names_.insert(name).second) {
      spdlog::error("wildcards skip \"{}\": {}", name, std::string(why.message()));
    }
  }
  void Remove(const std::string& name) {
    const MutexLock lock(mutex_);
    names_.erase(name);
  }
  int size() const {
    const MutexLock lock(mutex_);
    return static_cast<int>(names_.size());
  }

 private:
  mutable Mutex mutex_;
  std::set<std::string> names_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::server

#endif  // SERVER_CATALOG_DAMAGED_JOURNEYS_H_
