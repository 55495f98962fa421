// All journeys: on disk, and in memory once they are used. Source: own design.
#ifndef SERVER_SESSION_JOURNEY_CATALOG_H_
#define SERVER_SESSION_JOURNEY_CATALOG_H_

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/session/live_journey.h"
#include "server/session/resource_name.h"
#include "storage/journey_store.h"

namespace homing::server {

// Which journeys of many are there for the one who asks; empty: all.
using JourneyFilter = std::function<bool(const storage::JourneyRecord&)>;

// A stream's right to write a journey.
struct WriterClaim {
  std::shared_ptr<LiveJourney> journey;
  std::uint64_t claim = 0;
};

// Names given here are well formed (resource_name.h). Errors of the store pass through.
// Thread-safe.
class JourneyCatalog {
 public:
  // `store` must outlive the catalog.
  explicit JourneyCatalog(storage::JourneyStore* store) : store_(store) {}

  // Creates; or, when a journey of that name is active, of the same writer_id (not empty) and of
  // the same settings, returns that one. ALREADY_EXISTS.
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
  // An active writer's stream ends FAILED_PRECONDITION. NOT_FOUND; ABORTED: `writer_id` is not that
  // of the lease that lives.
  absl::StatusOr<storage::JourneyRecord> Finish(const std::string& name,
                                                const std::string& writer_id, TimePoint now);
  // ALREADY_EXISTS, INVALID_ARGUMENT.
  absl::StatusOr<storage::JourneyRecord> Import(const storage::JourneyRecord& record,
                                                const JourneyMap& map);

  // Loads the map on first use. NOT_FOUND.
  absl::StatusOr<std::shared_ptr<LiveJourney>> Open(const std::string& name);
  // All that `pattern` covers and, if it is one, `filter` lets through, in order of name.
  // NOT_FOUND: none.
  absl::StatusOr<LiveJourneys> Resolve(const JourneyName& pattern,
                                       const JourneyFilter& filter = nullptr);
  // As LiveJourney::Claim; the writer is kept on disk. NOT_FOUND.
  absl::StatusOr<WriterClaim> Claim(const std::string& name, const std::string& writer_id,
                                    TimePoint now, WriterLease::Evict evict);

 private:
  // Serialises what makes, loads, finishes and deletes one journey.
  std::mutex& StripeOf(const std::string& name);
  std::shared_ptr<LiveJourney> Find(const std::string& name);
  absl::StatusOr<std::shared_ptr<LiveJourney>> OpenLocked(const std::string& name);
  absl::StatusOr<storage::JourneyRecord> GetSameOrExists(const storage::JourneyRecord& record);

  absl::Status AddIfCovered(const JourneyName& pattern, const std::string& name,
                            LiveJourneys* journeys);

  storage::JourneyStore* const store_;
  std::array<std::mutex, 32> stripes_;
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<LiveJourney>> live_;
};

}  // namespace homing::server

#endif  // SERVER_SESSION_JOURNEY_CATALOG_H_
