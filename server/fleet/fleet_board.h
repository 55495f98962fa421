// The live state of all robots: the activity of each, its last answer, and since when it is lost.
// It is kept in memory only.
#ifndef SERVER_FLEET_FLEET_BOARD_H_
#define SERVER_FLEET_FLEET_BOARD_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "homing/base/mutex.h"
#include "homing/v1/fleet_service.pb.h"

namespace homing::server {

// The board wakes it when there is something new. Wake must not block, and may be called from any
// thread.
class FleetWatcher {
 public:
  virtual ~FleetWatcher() = default;
  virtual void Wake() = 0;
};

// Thread-safe.
class FleetBoard {
 public:
  // The stored journeys of one robot.
  struct Stored {
    std::int64_t journeys = 0;
    std::int64_t newest_ns = 0;
  };
  // The newest answer of one robot, for its watchers.
  struct Update {
    // Grows with each update; 0: none yet.
    std::int64_t number = 0;
    v1::WatchRobotResponse response;
  };

  // An open stream of a robot; the destructor closes it. Thread-safe.
  class Presence {
   public:
    Presence(FleetBoard* board, std::string robot);
    ~Presence();
    Presence(const Presence&) = delete;
    Presence& operator=(const Presence&) = delete;

    // True if the robot has watchers: only then the belief is computed.
    bool IsWatched() const;
    void ReportAnswer(const v1::LocalizeResponse& answer, v1::Belief belief);
    void ReportSteps(std::int64_t steps);

   private:
    FleetBoard* const board_;
    const std::string robot_;
  };

  // `now_ns` is the server's clock.
  explicit FleetBoard(std::function<std::int64_t()> now_ns);
  ~FleetBoard();

  // `robot` is "robots/{robot}"; null if it is empty: the stream belongs to no robot.
  std::unique_ptr<Presence> Enter(const std::string& robot, v1::Activity activity,
                                  const std::string& journey);
  // Replaces the counts of stored journeys; robots without any stay.
  void SetStored(const std::map<std::string, Stored>& stored);

  // The robots after the name `after`, at most `limit`, in order of name.
  std::vector<v1::Robot> List(const std::string& after, std::size_t limit) const;
  // The robots that changed after the change `since`, in order of name. Returns the number of the
  // last change.
  std::int64_t ChangesSince(std::int64_t since, std::vector<v1::Robot>* changed) const;
  // The newest answer; before the first one the robot's state, with number 0.
  Update Newest(const std::string& robot) const;

  // Wakes `watcher` after changes: of one robot at each answer, of all robots (empty name) at most
  // twice a second. Watchers that no longer exist take no more memory than those that do.
  void Watch(const std::string& robot, const std::weak_ptr<FleetWatcher>& watcher);
  struct Counts {
    int lost = 0;
    int localizing = 0;
    int recording = 0;
  };
  Counts Count() const;
  // True if there is a watcher of all robots.
  bool IsFleetWatched() const;

 private:
  struct Entry {
    v1::Robot robot;
    std::int64_t changed = 0;
    Update update;
  };
  using Watchers = std::vector<std::weak_ptr<FleetWatcher>>;
  // Robots on the board before some of those that left no journey are removed.
  static constexpr std::size_t kLeastEntryLimit = 10'000;

  Entry& EntryOf(const std::string& robot) HOMING_REQUIRES(mutex_);
  void MarkChanged(Entry* entry) HOMING_REQUIRES(mutex_);
  void Leave(const std::string& robot);
  // Changes the robot's entry, and wakes those that watch it.
  void Publish(const std::string& robot, const std::function<void(Entry*)>& change);
  void NoteSeen(Entry* entry);
  void RemoveOldWatchers() HOMING_REQUIRES(mutex_);
  void RemoveStrangers() HOMING_REQUIRES(mutex_);
  void RunPulse();

  const std::function<std::int64_t()> now_ns_;
  mutable Mutex mutex_;
  ConditionVariable pulse_;
  ConditionVariable stop_;
  std::map<std::string, Entry> entries_ HOMING_GUARDED_BY(mutex_);
  // The number of entries at which some are removed.
  std::size_t entry_limit_ HOMING_GUARDED_BY(mutex_) = kLeastEntryLimit;
  std::map<std::string, Watchers> watchers_ HOMING_GUARDED_BY(mutex_);
  // Entries of watchers_, and the number at which those that no longer exist are removed.
  std::size_t watcher_count_ HOMING_GUARDED_BY(mutex_) = 0;
  std::size_t watcher_limit_ HOMING_GUARDED_BY(mutex_) = 0;
  std::int64_t last_change_ HOMING_GUARDED_BY(mutex_) = 0;
  std::int64_t last_pulse_ HOMING_GUARDED_BY(mutex_) = 0;
  // The pulse waits for a change.
  bool idle_ HOMING_GUARDED_BY(mutex_) = false;
  bool stopping_ HOMING_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace homing::server

#endif  // SERVER_FLEET_FLEET_BOARD_H_
