#include "server/catalog/journey_cache.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace homing::server {

std::shared_ptr<LiveJourney> JourneyCache::Find(const std::string& name) {
  const MutexLock lock(mutex_);
  const auto found = entries_.find(name);
  if (found == entries_.end()) {
    return nullptr;
  }
  found->second.last_used = ++uses_;
  return found->second.journey;
}

void JourneyCache::Insert(const std::string& name, std::shared_ptr<LiveJourney> journey) {
  const MutexLock lock(mutex_);
  entries_[name] = {std::move(journey), ++uses_};
}

void JourneyCache::Erase(const std::string& name) {
  const MutexLock lock(mutex_);
  entries_.erase(name);
}

std::map<std::string, std::shared_ptr<LiveJourney>> JourneyCache::All() {
  const MutexLock lock(mutex_);
  std::map<std::string, std::shared_ptr<LiveJourney>> all;
  for (const auto& [name, entry] : entries_) all.emplace_hint(all.end(), name, entry.journey);
  return all;
}

void JourneyCache::SetTime(TimePoint now) {
  const MutexLock lock(mutex_);
  now_ = std::max(now_, now);
}

std::int64_t JourneyCache::EvictUnused() {
  if (limit_bytes_ <= 0) {
    return 0;
  }
  const MutexLock lock(mutex_);
  std::int64_t bytes = 0;
  std::vector<std::pair<std::uint64_t, std::map<std::string, Entry>::iterator>> unused;
  for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
    bytes += entry->second.journey->MemoryBytes();
    // use_count is 1: only the cache holds the journey, and nobody can get a reference meanwhile.
    if (entry->second.journey.use_count() == 1 && entry->second.journey->IsIdle(now_)) {
      unused.emplace_back(entry->second.last_used, entry);
    }
  }
  if (bytes <= limit_bytes_) {
    return bytes;
  }
  std::sort(unused.begin(), unused.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  // Evict down to 90 %, so that the next use does not evict again.
  for (const auto& [last_used, entry] : unused) {
    if (bytes <= limit_bytes_ / 10 * 9) {
      break;
    }
    bytes -= entry->second.journey->MemoryBytes();
    entries_.erase(entry);
  }
  return bytes;
}

}  // namespace homing::server
