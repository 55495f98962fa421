// The journeys in memory, with a limit on those that are not in use.
#ifndef SERVER_CATALOG_JOURNEY_CACHE_H_
#define SERVER_CATALOG_JOURNEY_CACHE_H_

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "homing/base/mutex.h"
#include "server/catalog/live_journey.h"

namespace homing::server {

// Thread-safe.
class JourneyCache {
 public:
  // `limit_bytes`: unused maps are evicted, least recently used first. 0: unlimited.
  explicit JourneyCache(std::int64_t limit_bytes) : limit_bytes_(limit_bytes) {}

  // Null if it is not in memory.
  std::shared_ptr<LiveJourney> Find(const std::string& name);
  void Insert(const std::string& name, std::shared_ptr<LiveJourney> journey);
  void Erase(const std::string& name);
  // The journeys by name; does not count as a use.
  std::map<std::string, std::shared_ptr<LiveJourney>> All();
  // Steady time, for leases; an earlier time than before is ignored.
  void SetTime(TimePoint now);
  // Evicts as limit_bytes requires. Returns the bytes that remain; 0 if unlimited.
  std::int64_t EvictUnused();

 private:
  struct Entry {
    std::shared_ptr<LiveJourney> journey;
    // A counter of uses: larger is more recent.
    std::uint64_t last_used = 0;
  };

  const std::int64_t limit_bytes_;
  Mutex mutex_;
  std::map<std::string, Entry> entries_ HOMING_GUARDED_BY(mutex_);
  std::uint64_t uses_ HOMING_GUARDED_BY(mutex_) = 0;
  TimePoint now_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::server

#endif  // SERVER_CATALOG_JOURNEY_CACHE_H_
