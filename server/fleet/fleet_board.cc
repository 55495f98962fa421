#include "server/fleet/fleet_board.h"

#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

namespace homing::server {
namespace {

using google::protobuf::util::TimeUtil;

// Half of the time within which a lost robot must be shown.
constexpr std::chrono::milliseconds kPulse{500};

constexpr std::size_t kLeastWatcherLimit = 64;

// The watchers that still exist; the others are removed.
std::vector<std::shared_ptr<FleetWatcher>> Alive(
    std::vector<std::weak_ptr<FleetWatcher>>* watchers) {
  std::vector<std::shared_ptr<FleetWatcher>> alive;
  std::erase_if(*watchers, [&](const std::weak_ptr<FleetWatcher>& watcher) {
    auto locked = watcher.lock();
    if (locked) alive.push_back(locked);
    return locked == nullptr;
  });
  return alive;
}

void NoteOutcome(const v1::LocalizeResponse& answer, std::int64_t now_ns, v1::Robot* robot) {
  if (answer.outcome() != v1::OUTCOME_UNKNOWN_PLACE) {
    robot->clear_lost_since();
  } else if (!robot->has_lost_since()) {
    *robot->mutable_lost_since() = TimeUtil::NanosecondsToTimestamp(now_ns);
  }
}

}  // namespace

FleetBoard::Presence::Presence(FleetBoard* board, std::string robot)
    : board_(board), robot_(std::move(robot)) {}

FleetBoard::Presence::~Presence() { board_->Leave(robot_); }

bool FleetBoard::Presence::IsWatched() const {
  const MutexLock lock(board_->mutex_);
  const auto found = board_->watchers_.find(robot_);
  return found != board_->watchers_.end() && !found->second.empty();
}

void FleetBoard::Presence::ReportAnswer(const v1::LocalizeResponse& answer, v1::Belief belief) {
  board_->Publish(robot_, [&](Entry* entry) {
    v1::Robot& robot = entry->robot;
    *robot.mutable_answer() = answer;
    robot.mutable_answer()->clear_matches();
    NoteOutcome(answer, board_->now_ns_(), &robot);
    board_->NoteSeen(entry);
    robot.set_observation_count(robot.observation_count() + 1);
    // Skips the copy with all matches, since most robots are not watched.
    entry->update.response.Clear();
    if (belief.masses_size() == 0) return;
    *entry->update.response.mutable_answer() = answer;
    *entry->update.response.mutable_belief() = std::move(belief);
  });
}

void FleetBoard::Presence::ReportSteps(std::int64_t steps) {
  board_->Publish(robot_, [board = board_, steps](Entry* entry) {
    board->NoteSeen(entry);
    entry->robot.set_recorded_steps(steps);
    entry->robot.set_observation_count(entry->robot.observation_count() + 1);
  });
}

FleetBoard::FleetBoard(std::function<std::int64_t()> now_ns)
    : now_ns_(std::move(now_ns)), thread_([this] { RunPulse(); }) {}

FleetBoard::~FleetBoard() {
  {
    const MutexLock lock(mutex_);
    stopping_ = true;
  }
  pulse_.NotifyAll();
  stop_.NotifyAll();
  thread_.join();
}

FleetBoard::Entry& FleetBoard::EntryOf(const std::string& robot) {
  if (entries_.size() >= entry_limit_ && entries_.count(robot) == 0) RemoveStrangers();
  Entry& entry = entries_[robot];
  if (entry.robot.name().empty()) {
    entry.robot.set_name(robot);
    entry.robot.set_activity(v1::ACTIVITY_OFFLINE);
  }
  return entry;
}

void FleetBoard::MarkChanged(Entry* entry) {
  entry->changed = ++last_change_;
  if (idle_) {
    idle_ = false;
    pulse_.NotifyAll();
  }
}

void FleetBoard::NoteSeen(Entry* entry) {
  *entry->robot.mutable_last_seen() = TimeUtil::NanosecondsToTimestamp(now_ns_());
}

std::unique_ptr<FleetBoard::Presence> FleetBoard::Enter(const std::string& robot,
                                                        v1::Activity activity,
                                                        const std::string& journey) {
  if (robot.empty()) return nullptr;
  Publish(robot, [&](Entry* entry) {
    NoteSeen(entry);
    entry->robot.set_activity(activity);
    entry->robot.set_journey(journey);
    entry->robot.set_open_streams(entry->robot.open_streams() + 1);
    entry->robot.clear_lost_since();
    entry->robot.clear_answer();
    entry->update.response.Clear();
  });
  return std::make_unique<Presence>(this, robot);
}

void FleetBoard::Leave(const std::string& robot) {
  Publish(robot, [](Entry* entry) {
    entry->robot.set_open_streams(entry->robot.open_streams() - 1);
    if (entry->robot.open_streams() == 0) entry->robot.set_activity(v1::ACTIVITY_OFFLINE);
  });
}

void FleetBoard::Publish(const std::string& robot, const std::function<void(Entry*)>& change) {
  std::vector<std::shared_ptr<FleetWatcher>> watchers;
  {
    const MutexLock lock(mutex_);
    Entry& entry = EntryOf(robot);
    change(&entry);
    MarkChanged(&entry);
    entry.update.number = last_change_;
    if (const auto found = watchers_.find(robot); found != watchers_.end()) {
      watchers = Alive(&found->second);
      if (watchers.empty()) watchers_.erase(found);
    }
  }
  for (const auto& watcher : watchers) watcher->Wake();
}

void FleetBoard::SetStored(const std::map<std::string, Stored>& stored) {
  const MutexLock lock(mutex_);
  for (auto& [name, entry] : entries_) {
    if (stored.count(name) == 0 && entry.robot.journey_count() != 0) {
      entry.robot.set_journey_count(0);
      MarkChanged(&entry);
    }
  }
  for (const auto& [name, counts] : stored) {
    Entry& entry = EntryOf(name);
    if (!entry.robot.has_last_seen()) {
      *entry.robot.mutable_last_seen() = TimeUtil::NanosecondsToTimestamp(counts.newest_ns);
    } else if (entry.robot.journey_count() == counts.journeys) {
      continue;
    }
    entry.robot.set_journey_count(counts.journeys);
    MarkChanged(&entry);
  }
}

std::vector<v1::Robot> FleetBoard::List(const std::string& after, std::size_t limit) const {
  const MutexLock lock(mutex_);
  std::vector<v1::Robot> robots;
  for (auto i = entries_.upper_bound(after); i != entries_.end() && robots.size() < limit; ++i) {
    robots.push_back(i->second.robot);
  }
  return robots;
}

std::int64_t FleetBoard::ChangesSince(std::int64_t since, std::vector<v1::Robot>* changed) const {
  const MutexLock lock(mutex_);
  for (const auto& [name, entry] : entries_) {
    if (entry.changed > since) changed->push_back(entry.robot);
  }
  return last_change_;
}

FleetBoard::Update FleetBoard::Newest(const std::string& robot) const {
  const MutexLock lock(mutex_);
  const auto found = entries_.find(robot);
  Update update;
  if (found == entries_.end()) {
    update.response.mutable_robot()->set_name(robot);
    update.response.mutable_robot()->set_activity(v1::ACTIVITY_OFFLINE);
    return update;
  }
  update = found->second.update;
  *update.response.mutable_robot() = found->second.robot;
  return update;
}

void FleetBoard::Watch(const std::string& robot, const std::weak_ptr<FleetWatcher>& watcher) {
  const MutexLock lock(mutex_);
  if (++watcher_count_ > watcher_limit_) RemoveOldWatchers();
  watchers_[robot].push_back(watcher);
  pulse_.NotifyAll();
}

// A caller may name any robot. Of those without a stream and a journey the older half is removed.
void FleetBoard::RemoveStrangers() {
  const auto is_stranger = [](const Entry& entry) {
    return entry.robot.open_streams() == 0 && entry.robot.journey_count() == 0;
  };
  std::vector<std::int64_t> changes;
  for (const auto& [name, entry] : entries_) {
    if (is_stranger(entry)) changes.push_back(entry.changed);
  }
  if (!changes.empty()) {
    const auto middle = changes.begin() + static_cast<std::ptrdiff_t>(changes.size() / 2);
    std::nth_element(changes.begin(), middle, changes.end());
    std::erase_if(entries_, [&](const auto& item) {
      return is_stranger(item.second) && item.second.changed <= *middle;
    });
  }
  entry_limit_ = std::max(kLeastEntryLimit, 2 * entries_.size());
}

// Publish removes the old watchers of a robot that changes; those of an idle robot would stay.
void FleetBoard::RemoveOldWatchers() {
  std::size_t left = 0;
  for (auto i = watchers_.begin(); i != watchers_.end();) {
    std::erase_if(i->second, [](const auto& watcher) { return watcher.expired(); });
    left += i->second.size();
    i = i->second.empty() ? watchers_.erase(i) : std::next(i);
  }
  watcher_count_ = left + 1;
  watcher_limit_ = 2 * left + kLeastWatcherLimit;
}

FleetBoard::Counts FleetBoard::Count() const {
  const MutexLock lock(mutex_);
  Counts counts;
  for (const auto& [name, entry] : entries_) {
    const bool localizes = entry.robot.activity() == v1::ACTIVITY_LOCALIZING;
    counts.localizing += localizes ? 1 : 0;
    counts.lost += localizes && entry.robot.has_lost_since() ? 1 : 0;
    counts.recording += entry.robot.activity() == v1::ACTIVITY_RECORDING ? 1 : 0;
  }
  return counts;
}

bool FleetBoard::IsFleetWatched() const {
  const MutexLock lock(mutex_);
  return watchers_.count("") != 0;
}

// Sleeps while nobody watches the fleet or nothing changes.
void FleetBoard::RunPulse() {
  MutexLock lock(mutex_);
  while (!stopping_) {
    const auto found = watchers_.find("");
    if (found == watchers_.end() || last_pulse_ == last_change_) {
      idle_ = found != watchers_.end();
      pulse_.Wait(mutex_);
      continue;
    }
    last_pulse_ = last_change_;
    const auto watchers = Alive(&found->second);
    if (watchers.empty()) watchers_.erase(found);
    lock.Unlock();
    for (const auto& watcher : watchers) watcher->Wake();
    lock.Lock();
    const auto next = std::chrono::steady_clock::now() + kPulse;
    while (!stopping_ && stop_.WaitUntil(mutex_, next)) {
    }
  }
}

}  // namespace homing::server
