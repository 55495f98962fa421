// All journeys: on disk, and in memory once they are used. Source: own design.
#ifndef SERVER_CATALOG_JOURNEY_CATALOG_H_
#define SERVER_CATALOG_JOURNEY_CATALOG_H_

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/base/resource_name.h"
#include "server/catalog/live_journey.h"
#include "storage/journey_store.h"

namespace homing::server {

class FleetIndex;
// Which journeys of many are there for the one who asks; empty: all.
using JourneyFilter = std::function<bool(const storage::JourneyRecord&)>;

// A stream's right to write a journey.
struct WriterClaim {
  std::shared_ptr<LiveJourney> journey;
  std::uint64_t claim = 0;
};

struct CatalogOptions {
  // Maps that no one uses are let go of, those unused longest first, while all together take more
  // than this, bytes. 0: no limit.
  std::int64_t cache_bytes = 0;
};

// Names given here are well formed (resource_name.h). Errors of the store pass through.
// Thread-safe.
class JourneyCatalog {
 public:
  // `store` must outlive the catalog; `index`, if there is one, as well: it is told of all changes.
  explicit JourneyCatalog(storage::JourneyStore* store, const CatalogOptions& options = {},
                          FleetIndex* index = nullptr)
      : store_(store), options_(options), index_(index) {}

  // Null: there is none.
  FleetIndex* index() const { return index_; }

  // Creates; or, when a journey of that name is active, of the same writer_id (not empty), settings
  // and readers (in any order), returns that one. ALREADY_EXISTS.
  absl::StatusOr<storage::JourneyRecord> Create(const storage::JourneyRecord& record);
  // As in memory when it is there, else as on disk. NOT_FOUND.
  absl::StatusOr<storage::JourneyRecord> Get(const std::string& name);
  // In order of name, after `after`, of one robot or of all (kWildcard), those that `filter` lets
  // through; at most `limit`.
  absl::StatusOr<std::vector<storage::JourneyRecord>> List(const std::string& robot,
                                                           const std::string& after, int limit,
                                                           const JourneyFilter& filter = nullptr);
  // An active writer's stream ends ABORTED. NOT_FOUND.
  absl::Status Delete(const std::string& name);
  // An active writer's stream ends FAILED_PRECONDITION. NOT_FOUND; ABORTED, unless `force`:
  // `writer_id` is not that of the lease that lives, or it is empty and a stream records.
  absl::StatusOr<storage::JourneyRecord> Finish(const std::string& name,
                                                const std::string& writer_id, bool force,
                                                TimePoint now);
  // NOT_FOUND.
  absl::StatusOr<storage::JourneyRecord> SetReaders(const std::string& name,
                                                    const std::vector<std::string>& readers);
  // ALREADY_EXISTS, INVALID_ARGUMENT.
  absl::StatusOr<storage::JourneyRecord> Import(const storage::JourneyRecord& record,
                                                const JourneyMap& map);

  // With its map, which is loaded on first use. NOT_FOUND.
  absl::StatusOr<std::shared_ptr<LiveJourney>> Open(const std::string& name);
  // All that `pattern` covers and, if it is one, `filter` lets through, in order of name, with
  // their maps. NOT_FOUND: none.
  absl::StatusOr<LiveJourneys> Resolve(const JourneyName& pattern,
                                       const JourneyFilter& filter = nullptr);
  // As LiveJourney::Claim; the writer is kept on disk. Loads no map. NOT_FOUND.
  absl::StatusOr<WriterClaim> Claim(const std::string& name, const std::string& writer_id,
                                    TimePoint now, WriterLease::Evict evict);

 private:
  // Serialises what makes, loads, finishes and deletes one journey.
  std::mutex& StripeOf(const std::string& name);
  std::shared_ptr<LiveJourney> Find(const std::string& name);
  // Without its map. REQUIRES: the stripe.
  absl::StatusOr<std::shared_ptr<LiveJourney>> OpenLocked(const std::string& name);
  absl::StatusOr<storage::JourneyRecord> GetSameOrExists(const storage::JourneyRecord& record);

  absl::Status AddIfCovered(const JourneyName& pattern, const std::string& name,
                            LiveJourneys* journeys);

  struct Cached {
    std::shared_ptr<LiveJourney> journey;
    // Grows with each use.
    std::uint64_t last_used = 0;
  };
  // REQUIRES: mutex_.
  std::shared_ptr<LiveJourney> Use(Cached* cached);
  // As cache_bytes says.
  void LetGoOfUnused();

  storage::JourneyStore* const store_;
  const CatalogOptions options_;
  FleetIndex* const index_;
  std::array<std::mutex, 32> stripes_;
  std::mutex mutex_;
  std::map<std::string, Cached> live_;
  std::uint64_t uses_ = 0;
  // The latest that a caller told.
  TimePoint now_;
};

}  // namespace homing::server

#endif  // SERVER_CATALOG_JOURNEY_CATALOG_H_
