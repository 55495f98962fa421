// All journeys: stored, and loaded while in use.
#ifndef SERVER_CATALOG_JOURNEY_CATALOG_H_
#define SERVER_CATALOG_JOURNEY_CATALOG_H_

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/base/cancellation.h"
#include "homing/base/mutex.h"
#include "server/base/memory_budget.h"
#include "server/base/resource_name.h"
#include "server/catalog/damaged_journeys.h"
#include "server/catalog/journey_cache.h"
#include "server/catalog/live_journey.h"
#include "storage/journey_store.h"

namespace homing::server {

class FleetIndex;
// Selects the journeys that a caller may use. Empty: all.
using JourneyFilter = std::function<bool(const storage::JourneyRecord&)>;

// A stream's right to write a journey.
struct WriterClaim {
  std::shared_ptr<LiveJourney> journey;
  std::uint64_t claim = 0;
  // The epoch to set in JourneyAppend.
  std::int64_t epoch = 0;
};

struct CatalogOptions {
  // Map-cache limit in bytes; unused maps are evicted, least recently used first. 0: unlimited.
  std::int64_t cache_bytes = 0;
  // Most memory of the beliefs of all localising streams, bytes. 0: no limit.
  std::int64_t belief_bytes = 0;
};

// Names must be well formed (resource_name.h). Errors of the store are returned unchanged.
// Thread-safe.
class JourneyCatalog {
 public:
  // `store`, and `index` unless null, must outlive the catalog. Every change is reported to
  // `index`.
  explicit JourneyCatalog(storage::JourneyStore* store, const CatalogOptions& options = {},
                          FleetIndex* index = nullptr)
      : store_(store),
        options_(options),
        index_(index),
        cache_(options.cache_bytes),
        beliefs_(options.belief_bytes) {}

  bool read_only() const { return store_->read_only(); }
  // Null without an index.
  FleetIndex* index() const { return index_; }
  // Memory of the beliefs of localising streams.
  MemoryBudget* beliefs() { return &beliefs_; }

  // Creates a journey. Returns the existing one if it is active and has the same writer_id (not
  // empty), settings and readers (in any order); else ALREADY_EXISTS.
  absl::StatusOr<storage::JourneyRecord> Create(const storage::JourneyRecord& record);
  // The loaded journey's record, or the stored one. NOT_FOUND.
  absl::StatusOr<storage::JourneyRecord> Get(const std::string& name);
  // The records after the name `after`, of one robot or of all (kWildcard), that pass `filter`; at
  // most `limit`, in order of name.
  absl::StatusOr<std::vector<storage::JourneyRecord>> List(const std::string& robot,
                                                           const std::string& after, int limit,
                                                           const JourneyFilter& filter = nullptr);
  // Ends an active writer's stream with ABORTED. NOT_FOUND.
  absl::Status Delete(const std::string& name);
  // Ends an active writer's stream with FAILED_PRECONDITION. NOT_FOUND; ABORTED, unless `force`:
  // another writer than `writer_id` holds the lease, or it is empty and a stream records.
  absl::StatusOr<storage::JourneyRecord> Finish(const std::string& name,
                                                const std::string& writer_id, bool force,
                                                TimePoint now);
  // NOT_FOUND.
  absl::StatusOr<storage::JourneyRecord> SetReaders(const std::string& name,
                                                    const std::vector<std::string>& readers);
  // ALREADY_EXISTS, INVALID_ARGUMENT.
  absl::StatusOr<storage::JourneyRecord> Import(const storage::JourneyRecord& record,
                                                const JourneyMap& map);

  // The journey with its map, loaded if necessary. NOT_FOUND.
  absl::StatusOr<std::shared_ptr<LiveJourney>> Open(const std::string& name);
  // The journeys that `pattern` covers, in order of name; `filter` applies to a wildcard only.
  // Loads no map. NOT_FOUND: none. CANCELLED.
  absl::StatusOr<LiveJourneys> Resolve(const JourneyName& pattern,
                                       const JourneyFilter& filter = nullptr,
                                       const Cancellation* cancellation = nullptr);
  // Loads the maps of journeys that Resolve returned for `pattern`. Of a wildcard, drops those that
  // were deleted meanwhile or are damaged. NOT_FOUND, DATA_LOSS: none is left. RESOURCE_EXHAUSTED:
  // the maps of a wildcard, and those in use by others, need more memory than cache_bytes.
  // CANCELLED.
  absl::Status LoadMaps(const JourneyName& pattern, LiveJourneys* journeys,
                        const Cancellation* cancellation = nullptr);
  // As LiveJourney::Claim. Loads no map. NOT_FOUND.
  absl::StatusOr<WriterClaim> Claim(const std::string& name, const std::string& writer_id,
                                    TimePoint now, WriterLease::Evict evict);

  // Journeys that were found damaged, and are skipped by wildcards.
  int damaged() const { return damaged_.size(); }

  // Other servers write to the store: a JourneyFollower must run.
  bool shared() const { return store_->shared(); }
  // The journeys in memory, by name.
  std::map<std::string, std::shared_ptr<LiveJourney>> InMemory() { return cache_.All(); }
  // Ends the use of a journey that is not in the store any more.
  void Drop(const std::shared_ptr<LiveJourney>& journey);

 private:
  // Serialises creation, loading, finishing and deletion of one journey.
  Mutex& StripeOf(const std::string& name);
  // Opens the journey without its map. REQUIRES: the stripe is locked.
  absl::StatusOr<std::shared_ptr<LiveJourney>> OpenLocked(const std::string& name);
  absl::StatusOr<storage::JourneyRecord> GetSameOrExists(const storage::JourneyRecord& record);

  absl::Status AddIfCovered(const JourneyName& pattern, const std::string& name,
                            LiveJourneys* journeys);
  absl::Status LoadMap(const JourneyName& pattern, LiveJourney* journey);
  // A wildcard continues without the journey, whose map could not be read.
  bool IsSkipped(const std::string& name, const absl::Status& status);
  // NOT_FOUND: a journey of that name is neither in memory nor on disk.
  absl::StatusOr<std::shared_ptr<LiveJourney>> FindOrOpen(const std::string& name);

  storage::JourneyStore* const store_;
  const CatalogOptions options_;
  FleetIndex* const index_;
  std::array<Mutex, 32> stripes_;
  JourneyCache cache_;
  MemoryBudget beliefs_;
  DamagedJourneys damaged_;
};

}  // namespace homing::server

#endif  // SERVER_CATALOG_JOURNEY_CATALOG_H_
