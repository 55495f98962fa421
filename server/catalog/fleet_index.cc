#include "server/catalog/fleet_index.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"
#include "server/base/error_reason.h"

namespace homing::server {
namespace {

constexpr int kRecordPage = 1000;
// Buckets swept at each change: well under a millisecond.
constexpr std::uint32_t kSweptAtOnce = 64;

}  // namespace

FleetIndex::FleetIndex(storage::JourneyStore* store)
    : store_(store), builder_([this] { Build(); }) {}

FleetIndex::~FleetIndex() {
  stopping_ = true;
  builder_.join();
}

void FleetIndex::Build() {
  const MutexLock lock(data_mutex_);
  index_.BeginLoading();
  const absl::Status status = LoadAll();
  index_.EndLoading();
  ApplyPending();
  const MutexLock queue_lock(queue_mutex_);
  build_status_ = status;
  ready_ = status.ok();
}

absl::Status FleetIndex::LoadAll() {
  std::string after;
  while (!stopping_) {
    HOMING_ASSIGN_OR_RETURN(const std::vector<storage::JourneyRecord> page,
                            store_->ListJourneys("robots/", after, kRecordPage));
    for (const storage::JourneyRecord& record : page) {
      HOMING_RETURN_IF_ERROR(Load(record));
    }
    if (page.size() < std::size_t{kRecordPage}) {
      return absl::OkStatus();
    }
    after = page.back().name;
  }
  return absl::CancelledError("the server is shutting down");
}

absl::Status FleetIndex::Load(const storage::JourneyRecord& record) {
  if (stopping_) {
    return absl::CancelledError("the server is shutting down");
  }
  const absl::StatusOr<JourneyMap> map = store_->LoadMap(record.name);
  if (absl::IsNotFound(map.status())) {
    // The journey was deleted after it was listed.
    return absl::OkStatus();
  }
  if (absl::IsDataLoss(map.status())) {
    spdlog::error("the index skips \"{}\": {}", record.name, std::string(map.status().message()));
    return absl::OkStatus();
  }
  HOMING_RETURN_IF_ERROR(map.status());
  const int journey = JourneyOf(record.name, map->settings());
  index_.Append(journey, *map);
  entries_[static_cast<std::size_t>(journey)].next_step = map->step_count();
  return absl::OkStatus();
}

void FleetIndex::Created(const std::string& name, const JourneySettings& settings) {
  Enqueue({name, settings, std::nullopt, nullptr, false});
}

void FleetIndex::Appended(const std::string& name, const JourneySettings& settings,
                          const JourneyStep& step) {
  Enqueue({name, settings, step, nullptr, false});
}

void FleetIndex::Imported(const std::string& name, const JourneySettings& settings,
                          const JourneyMap& map) {
  Enqueue({name, settings, std::nullopt, std::make_shared<const JourneyMap>(map), false});
}

void FleetIndex::Deleted(const std::string& name) {
  Enqueue({name, {}, std::nullopt, nullptr, true});
}

void FleetIndex::Enqueue(Change change) {
  {
    const MutexLock lock(queue_mutex_);
    queue_.push_back(std::move(change));
  }
  if (data_mutex_.TryLock()) {
    ApplyPending();
    data_mutex_.Unlock();
  }
}

void FleetIndex::ApplyPending() {
  std::vector<Change> changes;
  {
    const MutexLock lock(queue_mutex_);
    changes.swap(queue_);
  }
  for (const Change& change : changes) {
    Apply(change);
  }
  index_.Sweep(kSweptAtOnce);
}

void FleetIndex::Apply(const Change& change) {
  if (change.deleted) {
    return Remove(change.name);
  }
  Entry& entry = entries_[static_cast<std::size_t>(JourneyOf(change.name, change.settings))];
  const int journey = numbers_.at(change.name);
  // The index that was built from the store may already hold it.
  if (change.step && change.step->step >= entry.next_step) {
    index_.Append(journey, *change.step);
    entry.next_step = change.step->step + 1;
  } else if (change.map && entry.next_step == 0) {
    index_.Append(journey, *change.map);
    entry.next_step = change.map->step_count();
  }
}

// The number of a known or new journey. Updates its settings.
int FleetIndex::JourneyOf(const std::string& name, const JourneySettings& settings) {
  const std::size_t same = SettingsOf(settings);
  const auto found = numbers_.find(name);
  if (found == numbers_.end()) {
    const int journey = index_.AddJourney(name, settings.deviation_model);
    numbers_[name] = journey;
    entries_.resize(std::max(entries_.size(), static_cast<std::size_t>(journey) + 1));
    entries_[static_cast<std::size_t>(journey)] = {same, 0};
    ++settings_[same].journeys;
    return journey;
  }
  Entry& entry = entries_[static_cast<std::size_t>(found->second)];
  --settings_[entry.settings].journeys;
  entry.settings = same;
  ++settings_[same].journeys;
  return found->second;
}

std::size_t FleetIndex::SettingsOf(const JourneySettings& settings) {
  const auto found = std::find_if(settings_.begin(), settings_.end(), [&](const Settings& known) {
    return known.settings == settings;
  });
  if (found != settings_.end()) {
    return static_cast<std::size_t>(found - settings_.begin());
  }
  // A removed journey may still name the slot; no search covers that journey.
  const auto unused = std::find_if(settings_.begin(), settings_.end(),
                                   [](const Settings& known) { return known.journeys == 0; });
  if (unused == settings_.end()) {
    settings_.push_back({settings, 0});
    return settings_.size() - 1;
  }
  unused->settings = settings;
  return static_cast<std::size_t>(unused - settings_.begin());
}

void FleetIndex::Remove(const std::string& name) {
  const auto found = numbers_.find(name);
  if (found != numbers_.end()) {
    index_.Remove(found->second);
    --settings_[entries_[static_cast<std::size_t>(found->second)].settings].journeys;
    numbers_.erase(found);
  }
}

absl::Status FleetIndex::CheckReady() const {
  if (ready_) {
    return absl::OkStatus();
  }
  const MutexLock lock(queue_mutex_);
  return WithReason(
      absl::UnavailableError(absl::StrCat(
          "journey: \"robots/-/journeys/-\" needs the index of all journeys, which ",
          build_status_.ok() ? "is still being built"
                             : "could not be built: " + std::string(build_status_.message()))),
      {"INDEX_NOT_READY", {}});
}

FleetIndex::ReadLock::ReadLock(FleetIndex* index) : index_(index) {
  bool behind = false;
  {
    const MutexLock lock(index_->queue_mutex_);
    behind = !index_->queue_.empty();
  }
  if (behind) {
    const MutexLock lock(index_->data_mutex_);
    index_->ApplyPending();
  }
  index_->data_mutex_.LockShared();
}

absl::StatusOr<SettingsSelection> FleetIndex::SelectLocked(const QueryRobot& robot) const {
  std::vector<SettingsUse> uses;
  for (const Settings& settings : settings_) {
    uses.push_back({&settings.settings, settings.journeys, ""});
  }
  // The names are needed to break a tie only.
  HOMING_ASSIGN_OR_RETURN(SettingsSelection selection, SelectSettings(uses, robot));
  if (selection.is_tie) {
    for (const auto& [name, journey] : numbers_) {
      std::string& first = uses[entries_[static_cast<std::size_t>(journey)].settings].first_name;
      if (first.empty() || name < first) first = name;
    }
    return SelectSettings(uses, robot);
  }
  return selection;
}

absl::StatusOr<LocalizerOptions> FleetIndex::Select(const QueryRobot& robot) {
  HOMING_RETURN_IF_ERROR(CheckReady());
  const ReadLock lock(this);
  HOMING_ASSIGN_OR_RETURN(SettingsSelection selection, SelectLocked(robot));
  return selection.options;
}

absl::StatusOr<std::vector<std::pair<std::string, Match>>> FleetIndex::Find(
    const QueryRobot& robot, const SeenSides& seen, const MatchOptions& options) {
  HOMING_RETURN_IF_ERROR(CheckReady());
  const ReadLock lock(this);
  HOMING_ASSIGN_OR_RETURN(const SettingsSelection selection, SelectLocked(robot));
  const auto covers = [&](int journey) HOMING_REQUIRES_SHARED(data_mutex_) {
    return bool{selection.chosen[entries_[static_cast<std::size_t>(journey)].settings]};
  };
  std::vector<std::pair<std::string, Match>> matches;
  for (const Match& match : index_.FindLandmarks(seen, options, covers)) {
    matches.emplace_back(index_.name(match.journey), match);
  }
  return matches;
}

}  // namespace homing::server
