// A journey in use, shared by its writer and all streams that localise on it.
#ifndef SERVER_CATALOG_LIVE_JOURNEY_H_
#define SERVER_CATALOG_LIVE_JOURNEY_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/base/mutex.h"
#include "homing/journey/journey_map.h"
#include "homing/journey/journey_recorder.h"
#include "homing/journey/journey_ref.h"
#include "server/catalog/writer_lease.h"
#include "storage/journey_store.h"

namespace homing::server {

class FleetIndex;

// A writer's claim of a journey: its number in this server, and its epoch in the store.
struct LiveClaim {
  std::uint64_t number = 0;
  std::int64_t epoch = 0;
};

// Holds committed state only. Thread-safe. The map is loaded when the first reader needs it, since
// most recorded journeys have no reader. From then on committed steps wait in a short list until a
// reader or an idle moment applies them to the map: the committing thread never waits for threads
// that load or localise.
class LiveJourney {
 public:
  // `record` as in the store. Each step is reported to `index` unless it is null. `store` and
  // `index` must outlive the journey.
  LiveJourney(storage::JourneyRecord record, storage::JourneyStore* store,
              FleetIndex* index = nullptr);

  const std::string& name() const { return name_; }
  // The record with the current counts.
  storage::JourneyRecord record() const;
  JourneySettings settings() const { return record().settings; }
  bool deleted() const;
  // Approximate memory, with the map if it is loaded.
  std::int64_t MemoryBytes() const;
  // No writer holds the lease at `now`, and no append is pending.
  bool IsIdle(TimePoint now) const;

  // -- Writing. A stream holds a claim from its first message on.

  // Gives the journey to `writer_id`: ends the previous claim (calls its evict with ABORTED), waits
  // until its pending appends are committed, and acquires the journey in the store.
  // FAILED_PRECONDITION: finished; ABORTED: another writer holds the lease; NOT_FOUND: deleted;
  // errors of the store. REQUIRES: one call at a time.
  absl::StatusOr<LiveClaim> Claim(const std::string& writer_id, TimePoint now,
                                  WriterLease::Evict evict);
  // The error that Claim would return.
  absl::Status CheckClaim(const std::string& writer_id, TimePoint now) const;
  // Renews the lease. ABORTED: the claim has ended.
  absl::Status Renew(std::uint64_t claim, TimePoint now);
  // Call it before each append is submitted, and EndAppend after it. ABORTED: the claim has ended.
  absl::Status BeginAppend(std::uint64_t claim);
  // `status` is the result of the commit; if OK, the journey grows.
  void EndAppend(const storage::JourneyAppend& append, const absl::Status& status);
  // State needed to resume recording. REQUIRES: this claim has appended nothing yet. Errors of the
  // store.
  absl::StatusOr<JourneyTail> LoadTail() const { return store_->LoadTail(name_); }
  // Ends the claim, if there is one, with `reason`, and waits until its pending appends are
  // committed.
  void EvictWriter(const absl::Status& reason);
  // ABORTED: a stream records it.
  absl::Status CheckNoStream(TimePoint now) const;
  // The stream of a claim has ended.
  void EndStream(std::uint64_t claim);
  void SetReaders(const std::vector<std::string>& readers);
  // ABORTED: another writer holds the lease.
  absl::Status CheckWriter(const std::string& writer_id, TimePoint now) const;
  void MarkFinished();
  void MarkDeleted();

  // -- Of a store that other servers write to.

  // Compares with `mark`, which is of this moment or earlier. Ends the claim of a writer that was
  // replaced or whose journey was finished, and catches up. Errors of the store.
  absl::Status Follow(const storage::JourneyMark& mark);
  // Takes over the stored state, with the steps that other servers added. Errors of the store.
  absl::Status CatchUp();

  // -- Reading.

  // Loads the map if necessary; recording continues meanwhile. NOT_FOUND: deleted. After an error
  // of the store there is no map, and the next call tries again.
  absl::Status LoadMap();
  bool has_map() const;
  // Locks the map for reading, with all committed steps. REQUIRES: has_map. Several journeys must
  // be locked in order of name, each once.
  void LockMap() HOMING_ACQUIRE_SHARED(map_mutex_);
  void UnlockMap() HOMING_RELEASE_SHARED(map_mutex_) { map_mutex_.UnlockShared(); }
  // REQUIRES: between LockMap and UnlockMap. MapsLock locks many, which the analysis cannot follow.
  const JourneyMap& map() const HOMING_UNCHECKED_LOCKS { return map_; }

 private:
  // Steps that are committed while the map is being loaded are kept: the store may have read its
  // rows before them.
  enum class MapState { kNone, kLoading, kLoaded };

  absl::Status CheckPresent() const HOMING_REQUIRES(mutex_);
  absl::Status CheckWritable() const HOMING_REQUIRES(mutex_);
  void AwaitQuiet() HOMING_REQUIRES(mutex_);
  // False: the map was requested meanwhile, and its new steps were not loaded.
  bool TakeGrowth(storage::JourneyGrowth growth, bool with_steps);
  void ApplyPending() HOMING_REQUIRES(map_mutex_);

  const std::string name_;
  storage::JourneyStore* const store_;
  FleetIndex* const index_;

  // Held while loading. Lock order: load_mutex_, map_mutex_, mutex_.
  Mutex load_mutex_;
  SharedMutex map_mutex_;
  JourneyMap map_ HOMING_GUARDED_BY(map_mutex_);

  mutable Mutex mutex_;
  ConditionVariable quiet_;
  storage::JourneyRecord record_ HOMING_GUARDED_BY(mutex_);
  WriterLease lease_ HOMING_GUARDED_BY(mutex_);
  // Claim has not returned yet.
  bool is_claiming_ HOMING_GUARDED_BY(mutex_) = false;
  // Epoch of the last claim in this server; 0: none.
  std::int64_t epoch_ HOMING_GUARDED_BY(mutex_) = 0;
  // JourneyMark::revision of record_; -1: unknown.
  std::int64_t revision_ HOMING_GUARDED_BY(mutex_) = -1;
  int appends_under_way_ HOMING_GUARDED_BY(mutex_) = 0;
  bool deleted_ HOMING_GUARDED_BY(mutex_) = false;
  MapState map_state_ HOMING_GUARDED_BY(mutex_) = MapState::kNone;
  // Committed steps that are not in map_ yet (the loaded map may hold some). Empty without a map.
  std::vector<JourneyStep> pending_ HOMING_GUARDED_BY(mutex_);
  bool settings_changed_ HOMING_GUARDED_BY(mutex_) = false;
};

using LiveJourneys = std::vector<std::shared_ptr<LiveJourney>>;

// Locks the maps of journeys for reading. REQUIRES: all are loaded; in order of name, each once.
class MapsLock {
 public:
  explicit MapsLock(const LiveJourneys& journeys);
  ~MapsLock();
  MapsLock(const MapsLock&) = delete;
  MapsLock& operator=(const MapsLock&) = delete;

  // The locked maps with their names, in the order of the journeys.
  std::vector<JourneyRef> refs() const;

 private:
  const LiveJourneys& journeys_;
};

}  // namespace homing::server

#endif  // SERVER_CATALOG_LIVE_JOURNEY_H_
