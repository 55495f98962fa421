// An index of the landmarks of all journeys, for queries over all of them.
#ifndef SERVER_CATALOG_FLEET_INDEX_H_
#define SERVER_CATALOG_FLEET_INDEX_H_

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/base/mutex.h"
#include "homing/matching/landmark_index.h"
#include "server/catalog/journey_selection.h"
#include "storage/journey_store.h"

namespace homing::server {

// Thread-safe. One thread builds it from the store; changes made meanwhile wait in a queue. Once it
// is built, changes still go through the queue: writers never block on queries, and each change is
// visible to the next query.
class FleetIndex {
 public:
  // Starts building. `store` must outlive the index.
  explicit FleetIndex(storage::JourneyStore* store);
  // Stops building.
  ~FleetIndex();
  FleetIndex(const FleetIndex&) = delete;
  FleetIndex& operator=(const FleetIndex&) = delete;

  // -- Committed changes. Call each once, and those of one journey in their order.

  void Created(const std::string& name, const JourneySettings& settings);
  void Appended(const std::string& name, const JourneySettings& settings, const JourneyStep& step);
  void Imported(const std::string& name, const JourneySettings& settings, const JourneyMap& map);
  void Deleted(const std::string& name);

  // -- Queries.

  // UNAVAILABLE: the index is not built yet, or building failed.
  absl::Status CheckReady() const;
  // The options for the journeys whose camera and settings match the robot's, selected as by
  // SelectJourneys. UNAVAILABLE; NOT_FOUND: there is no journey; FAILED_PRECONDITION: none matches.
  absl::StatusOr<LocalizerOptions> Select(const QueryRobot& robot);
  // As homing::Matcher::Find over the journeys that Select selects. Match::journey has no meaning
  // here.
  absl::StatusOr<std::vector<std::pair<std::string, Match>>> Find(const QueryRobot& robot,
                                                                  const SeenSides& seen,
                                                                  const MatchOptions& options);

 private:
  // A created journey sets neither `step` nor `map`; a change sets at most one of them.
  struct Change {
    std::string name;
    JourneySettings settings;
    std::optional<JourneyStep> step;
    std::shared_ptr<const JourneyMap> map;
    bool deleted = false;
  };
  // Indexed by the journey's number in the index.
  struct Entry {
    std::size_t settings = 0;
    // The first step that is not in the index.
    std::int64_t next_step = 0;
  };
  // Number of journeys that have these settings.
  struct Settings {
    JourneySettings settings;
    std::int64_t journeys = 0;
  };

  // Locks the data for reading, with all pending changes applied.
  class HOMING_THREAD_ATTRIBUTE(scoped_lockable) ReadLock {
   public:
    explicit ReadLock(FleetIndex* index) HOMING_ACQUIRE_SHARED(index->data_mutex_);
    ~ReadLock() HOMING_RELEASE() { index_->data_mutex_.UnlockShared(); }
    ReadLock(const ReadLock&) = delete;
    ReadLock& operator=(const ReadLock&) = delete;

   private:
    FleetIndex* const index_;
  };

  void Build();
  absl::Status LoadAll() HOMING_REQUIRES(data_mutex_);
  absl::Status Load(const storage::JourneyRecord& record) HOMING_REQUIRES(data_mutex_);
  void Enqueue(Change change);
  void ApplyPending() HOMING_REQUIRES(data_mutex_);
  void Apply(const Change& change) HOMING_REQUIRES(data_mutex_);
  int JourneyOf(const std::string& name, const JourneySettings& settings)
      HOMING_REQUIRES(data_mutex_);
  std::size_t SettingsOf(const JourneySettings& settings) HOMING_REQUIRES(data_mutex_);
  void Remove(const std::string& name) HOMING_REQUIRES(data_mutex_);
  absl::StatusOr<SettingsSelection> SelectLocked(const QueryRobot& robot) const
      HOMING_REQUIRES_SHARED(data_mutex_);

  storage::JourneyStore* const store_;
  std::atomic<bool> ready_ = false;
  std::atomic<bool> stopping_ = false;

  // Lock order: data_mutex_ before queue_mutex_.
  SharedMutex data_mutex_;
  LandmarkIndex index_ HOMING_GUARDED_BY(data_mutex_);
  std::unordered_map<std::string, int> numbers_ HOMING_GUARDED_BY(data_mutex_);
  std::vector<Entry> entries_ HOMING_GUARDED_BY(data_mutex_);
  std::vector<Settings> settings_ HOMING_GUARDED_BY(data_mutex_);

  mutable Mutex queue_mutex_;
  std::vector<Change> queue_ HOMING_GUARDED_BY(queue_mutex_);
  absl::Status build_status_ HOMING_GUARDED_BY(queue_mutex_);

  std::thread builder_;
};

}  // namespace homing::server

#endif  // SERVER_CATALOG_FLEET_INDEX_H_
