// Keeps the journeys in memory equal to a store that other servers write to.
#ifndef SERVER_CATALOG_JOURNEY_FOLLOWER_H_
#define SERVER_CATALOG_JOURNEY_FOLLOWER_H_

#include <chrono>

#include "absl/status/status.h"
#include "server/base/periodic_thread.h"
#include "server/catalog/journey_catalog.h"
#include "storage/journey_store.h"

namespace homing::server {

// One thread asks the store which journeys changed. A journey that is recorded through another
// server is localised on through this one after at most one interval and one read.
class JourneyFollower {
 public:
  static constexpr std::chrono::milliseconds kInterval{200};

  // Both must outlive the follower.
  JourneyFollower(storage::JourneyStore* store, JourneyCatalog* catalog);

 private:
  // Errors of the store; the next round tries again.
  absl::Status FollowAll();

  storage::JourneyStore* const store_;
  JourneyCatalog* const catalog_;
  PeriodicThread thread_;
};

}  // namespace homing::server

#endif  // SERVER_CATALOG_JOURNEY_FOLLOWER_H_
