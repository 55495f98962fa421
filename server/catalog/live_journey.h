// A journey that is in use, shared by its writer and by all who localise on it. Source: own design.
#ifndef SERVER_CATALOG_LIVE_JOURNEY_H_
#define SERVER_CATALOG_LIVE_JOURNEY_H_

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/journey/journey_map.h"
#include "homing/journey/journey_recorder.h"
#include "server/catalog/writer_lease.h"
#include "storage/journey_store.h"

namespace homing::server {

class FleetIndex;

// Holds nothing that is not durable. Thread-safe. There is no map until someone is to read it: most
// journeys that are recorded have no reader. From then on steps that were committed wait in a short
// list until a reader or an idle moment takes them into the map: the thread that commits never
// waits for those who load or localise. (std::shared_mutex rather than absl::Mutex: ThreadSanitizer
// sees it.)
class LiveJourney {
 public:
  // `record` as in the store. `index`, unless null, is told of each step. Both must outlive the
  // journey.
  LiveJourney(storage::JourneyRecord record, storage::JourneyStore* store,
              FleetIndex* index = nullptr);

  const std::string& name() const { return name_; }
  // With counts as of now.
  storage::JourneyRecord record() const;
  JourneySettings settings() const { return record().settings; }
  bool deleted() const;
  // What it takes, about, with its map if that is loaded.
  std::int64_t MemoryBytes() const;
  // No writer's lease lives at `now`, and nothing is on its way to the disk.
  bool IsIdle(TimePoint now) const;

  // -- Writing. A claim is what a stream holds from its first message on.

  // Takes the journey over for `writer_id`: ends the claim before (its evict is called with
  // ABORTED), then waits until nothing of it is on its way to the disk. FAILED_PRECONDITION:
  // finished; ABORTED: another writer's lease lives; NOT_FOUND: deleted.
  absl::StatusOr<std::uint64_t> Claim(const std::string& writer_id, TimePoint now,
                                      WriterLease::Evict evict);
  // Whether Claim would be refused, and why.
  absl::Status CheckClaim(const std::string& writer_id, TimePoint now) const;
  // Renews the lease. ABORTED: the claim is over.
  absl::Status Renew(std::uint64_t claim, TimePoint now);
  // Every append handed to the disk is between these two. ABORTED: the claim is over.
  absl::Status BeginAppend(std::uint64_t claim);
  // `status` is what the disk said; when OK the journey grows.
  void EndAppend(const storage::JourneyAppend& append, const absl::Status& status);
  // What the recording of this claim goes on from. REQUIRES: it has appended nothing yet. Errors of
  // the store.
  absl::StatusOr<JourneyTail> LoadTail() const { return store_->LoadTail(name_); }
  // Ends the claim with `reason`, if there is one, and waits until nothing is on its way to the
  // disk.
  void EvictWriter(const absl::Status& reason);
  // ABORTED: another writer's lease lives.
  // ABORTED: a stream records it.
  absl::Status CheckNoStream(TimePoint now) const;
  // The stream of a claim has ended.
  void EndStream(std::uint64_t claim);
  void SetReaders(const std::vector<std::string>& readers);
  absl::Status CheckWriter(const std::string& writer_id, TimePoint now) const;
  void MarkFinished();
  void MarkDeleted();

  // -- Reading.

  // Loads the map unless that was done; recording goes on meanwhile. NOT_FOUND: deleted. After an
  // error of the store there is no map, and the next call tries again.
  absl::Status LoadMap();
  bool has_map() const;
  // Takes the map for reading, up to date. REQUIRES: has_map; journeys locked together are locked
  // in order of name, each once.
  void LockMap();
  void UnlockMap() { map_mutex_.unlock_shared(); }
  // REQUIRES: between LockMap and UnlockMap.
  const JourneyMap& map() const { return map_; }

 private:
  // Steps that are committed while the map is being loaded are kept: the store may have read the
  // rows before.
  enum class MapState { kNone, kLoading, kLoaded };

  absl::Status CheckPresent() const;
  absl::Status CheckWritable() const;
  void AwaitQuiet(std::unique_lock<std::mutex>* lock);
  void AbsorbSteps();

  const std::string name_;
  storage::JourneyStore* const store_;
  FleetIndex* const index_;

  // One loads. Locked before map_mutex_.
  std::mutex load_mutex_;
  // Locked before mutex_.
  std::shared_mutex map_mutex_;
  JourneyMap map_;

  mutable std::mutex mutex_;
  std::condition_variable quiet_;
  storage::JourneyRecord record_;
  WriterLease lease_;
  int appends_under_way_ = 0;
  bool deleted_ = false;
  MapState map_state_ = MapState::kNone;
  // Durable, and not yet in map_ unless it was loaded with them. Empty without a map.
  std::vector<JourneyStep> unabsorbed_;
  bool settings_changed_ = false;
};

using LiveJourneys = std::vector<std::shared_ptr<LiveJourney>>;

// Holds the maps of journeys for reading. REQUIRES: all are loaded; in order of name, each once.
class MapsLock {
 public:
  explicit MapsLock(const LiveJourneys& journeys);
  ~MapsLock();
  MapsLock(const MapsLock&) = delete;
  MapsLock& operator=(const MapsLock&) = delete;

 private:
  const LiveJourneys& journeys_;
};

}  // namespace homing::server

#endif  // SERVER_CATALOG_LIVE_JOURNEY_H_
