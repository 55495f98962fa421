#include "server/catalog/journey_catalog.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "server/base/error_reason.h"
#include "server/catalog/fleet_index.h"

namespace homing::server {
namespace {

using storage::JourneyRecord;

constexpr int kListPage = 1000;

std::string PrefixOf(const std::string& robot) {
  return robot == kWildcard ? "robots/" : absl::StrCat("robots/", robot, "/journeys/");
}

// Image sizes that the request left open are filled in by the first observation: they differ
// without being other settings.
JourneySettings WithSizesOf(JourneySettings settings, const JourneySettings& known) {
  for (std::size_t side = 0; side < settings.cameras.size(); ++side) {
    if (settings.cameras[side].width == 0 && settings.cameras[side].height == 0) {
      settings.cameras[side].width = known.cameras[side].width;
      settings.cameras[side].height = known.cameras[side].height;
    }
  }
  return settings;
}

bool IsSameJourney(const JourneyRecord& wanted, const JourneyRecord& present) {
  return present.state == storage::JourneyState::kActive && !wanted.writer_id.empty() &&
         wanted.writer_id == present.writer_id &&
         std::ranges::is_permutation(wanted.readers, present.readers) &&
         WithSizesOf(wanted.settings, present.settings) == present.settings;
}

}  // namespace

std::mutex& JourneyCatalog::StripeOf(const std::string& name) {
  return stripes_[std::hash<std::string>()(name) % stripes_.size()];
}

std::shared_ptr<LiveJourney> JourneyCatalog::Find(const std::string& name) {
  const std::lock_guard lock(mutex_);
  const auto found = live_.find(name);
  return found == live_.end() ? nullptr : Use(&found->second);
}

std::shared_ptr<LiveJourney> JourneyCatalog::Use(Cached* cached) {
  cached->last_used = ++uses_;
  return cached->journey;
}

void JourneyCatalog::LetGoOfUnused() {
  if (options_.cache_bytes <= 0) {
    return;
  }
  const std::lock_guard lock(mutex_);
  std::int64_t bytes = 0;
  std::vector<std::pair<std::uint64_t, std::map<std::string, Cached>::iterator>> unused;
  for (auto cached = live_.begin(); cached != live_.end(); ++cached) {
    bytes += cached->second.journey->MemoryBytes();
    // Only the catalog holds it, and the catalog alone hands it out.
    if (cached->second.journey.use_count() == 1 && cached->second.journey->IsIdle(now_)) {
      unused.emplace_back(cached->second.last_used, cached);
    }
  }
  if (bytes <= options_.cache_bytes) {
    return;
  }
  std::sort(unused.begin(), unused.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  // Some room is made at once, so that this is not done at each use.
  for (const auto& [last_used, cached] : unused) {
    if (bytes <= options_.cache_bytes / 10 * 9) {
      return;
    }
    bytes -= cached->second.journey->MemoryBytes();
    live_.erase(cached);
  }
}

absl::StatusOr<std::shared_ptr<LiveJourney>> JourneyCatalog::OpenLocked(const std::string& name) {
  if (auto journey = Find(name)) {
    return journey;
  }
  HOMING_ASSIGN_OR_RETURN(JourneyRecord record, store_->GetJourney(name));
  auto journey = std::make_shared<LiveJourney>(std::move(record), store_, index_);
  const std::lock_guard lock(mutex_);
  live_[name] = {journey, ++uses_};
  return journey;
}

absl::StatusOr<std::shared_ptr<LiveJourney>> JourneyCatalog::Open(const std::string& name) {
  auto journey = Find(name);
  if (!journey) {
    const std::lock_guard lock(StripeOf(name));
    HOMING_ASSIGN_OR_RETURN(journey, OpenLocked(name));
  }
  if (!journey->has_map()) {
    // Without the stripe: a long map keeps no writer waiting.
    HOMING_RETURN_IF_ERROR(journey->LoadMap());
    LetGoOfUnused();
  }
  return journey;
}

absl::StatusOr<JourneyRecord> JourneyCatalog::GetSameOrExists(const JourneyRecord& record) {
  HOMING_ASSIGN_OR_RETURN(JourneyRecord present, Get(record.name));
  if (IsSameJourney(record, present)) {
    return present;
  }
  return absl::AlreadyExistsError(
      absl::StrCat("journey is \"", record.name,
                   "\"; it exists, and is finished, or has another writer_id, other settings or "
                   "other readers (SetReaders changes these)"));
}

absl::StatusOr<JourneyRecord> JourneyCatalog::Create(const JourneyRecord& record) {
  const std::lock_guard lock(StripeOf(record.name));
  const absl::Status status = store_->CreateJourney(record);
  if (absl::IsAlreadyExists(status)) {
    return GetSameOrExists(record);
  }
  HOMING_RETURN_IF_ERROR(status);
  if (index_ != nullptr) {
    index_->Created(record.name, record.settings);
  }
  return store_->GetJourney(record.name);
}

absl::StatusOr<JourneyRecord> JourneyCatalog::Get(const std::string& name) {
  if (const auto journey = Find(name)) {
    return journey->record();
  }
  return store_->GetJourney(name);
}

absl::StatusOr<std::vector<JourneyRecord>> JourneyCatalog::List(const std::string& robot,
                                                                const std::string& after, int limit,
                                                                const JourneyFilter& filter) {
  std::vector<JourneyRecord> records;
  std::string last = after;
  while (true) {
    HOMING_ASSIGN_OR_RETURN(std::vector<JourneyRecord> page,
                            store_->ListJourneys(PrefixOf(robot), last, limit));
    const bool is_last = page.size() < static_cast<std::size_t>(limit);
    last = page.empty() ? last : page.back().name;
    for (JourneyRecord& record : page) {
      if (!filter || filter(record)) {
        records.push_back(std::move(record));
      }
      if (records.size() == static_cast<std::size_t>(limit)) {
        return records;
      }
    }
    if (is_last) {
      return records;
    }
  }
}

absl::Status JourneyCatalog::Delete(const std::string& name) {
  const std::lock_guard lock(StripeOf(name));
  const auto journey = Find(name);
  if (journey) {
    journey->EvictWriter(
        WithReason(absl::AbortedError(absl::StrCat("journey is \"", name, "\"; it was deleted")),
                   {"JOURNEY_DELETED", {}}));
  }
  HOMING_RETURN_IF_ERROR(store_->DeleteJourney(name));
  if (index_ != nullptr) {
    index_->Deleted(name);
  }
  if (journey) {
    journey->MarkDeleted();
    const std::lock_guard table_lock(mutex_);
    live_.erase(name);
  }
  return absl::OkStatus();
}

absl::StatusOr<JourneyRecord> JourneyCatalog::Finish(const std::string& name,
                                                     const std::string& writer_id, bool force,
                                                     TimePoint now) {
  const std::lock_guard lock(StripeOf(name));
  const auto journey = Find(name);
  if (journey) {
    if (!force) {
      HOMING_RETURN_IF_ERROR(writer_id.empty() ? journey->CheckNoStream(now)
                                               : journey->CheckWriter(writer_id, now));
    }
    journey->EvictWriter(
        WithReason(absl::FailedPreconditionError(absl::StrCat(
                       "journey is \"", name, "\"; it is finished and takes no observations")),
                   {"JOURNEY_FINISHED", {}}));
  }
  HOMING_RETURN_IF_ERROR(store_->FinishJourney(name));
  if (journey) {
    journey->MarkFinished();
  }
  return Get(name);
}

absl::StatusOr<JourneyRecord> JourneyCatalog::SetReaders(const std::string& name,
                                                         const std::vector<std::string>& readers) {
  const std::lock_guard lock(StripeOf(name));
  HOMING_RETURN_IF_ERROR(store_->SetReaders(name, readers));
  if (const auto journey = Find(name)) {
    journey->SetReaders(readers);
  }
  return Get(name);
}

absl::StatusOr<JourneyRecord> JourneyCatalog::Import(const JourneyRecord& record,
                                                     const JourneyMap& map) {
  const std::lock_guard lock(StripeOf(record.name));
  HOMING_RETURN_IF_ERROR(store_->ImportJourney(record, map));
  if (index_ != nullptr) {
    index_->Imported(record.name, record.settings, map);
  }
  return store_->GetJourney(record.name);
}

absl::Status JourneyCatalog::AddIfCovered(const JourneyName& pattern, const std::string& name,
                                          LiveJourneys* journeys) {
  HOMING_ASSIGN_OR_RETURN(const JourneyName parsed, ParseJourneyName(name, "journey"));
  if (!Covers(pattern, parsed)) {
    return absl::OkStatus();
  }
  auto journey = Open(name);
  if (!journey.ok()) {
    // Deleted since it was listed: it is not there, which is no error of a wildcard.
    return absl::IsNotFound(journey.status()) ? absl::OkStatus() : journey.status();
  }
  journeys->push_back(*std::move(journey));
  return absl::OkStatus();
}

absl::StatusOr<LiveJourneys> JourneyCatalog::Resolve(const JourneyName& pattern,
                                                     const JourneyFilter& filter) {
  LiveJourneys journeys;
  if (!pattern.is_pattern()) {
    HOMING_ASSIGN_OR_RETURN(auto journey, Open(pattern.ToString()));
    journeys.push_back(std::move(journey));
    return journeys;
  }
  std::string after;
  while (true) {
    HOMING_ASSIGN_OR_RETURN(const std::vector<JourneyRecord> page,
                            store_->ListJourneys(PrefixOf(pattern.robot), after, kListPage));
    for (const JourneyRecord& record : page) {
      if (!filter || filter(record)) {
        HOMING_RETURN_IF_ERROR(AddIfCovered(pattern, record.name, &journeys));
      }
    }
    if (page.size() < std::size_t{kListPage}) {
      break;
    }
    after = page.back().name;
  }
  if (journeys.empty()) {
    return absl::NotFoundError(
        absl::StrCat("journey is \"", pattern.ToString(), "\"; no journey is covered by it"));
  }
  return journeys;
}

absl::StatusOr<WriterClaim> JourneyCatalog::Claim(const std::string& name,
                                                  const std::string& writer_id, TimePoint now,
                                                  WriterLease::Evict evict) {
  if (store_->read_only()) {
    return absl::FailedPreconditionError("the server is read-only: it records nothing");
  }
  const std::lock_guard lock(StripeOf(name));
  auto journey = Find(name);
  if (!journey) {
    HOMING_ASSIGN_OR_RETURN(journey, OpenLocked(name));
    LetGoOfUnused();
  }
  {
    const std::lock_guard table_lock(mutex_);
    now_ = std::max(now_, now);
  }
  HOMING_RETURN_IF_ERROR(journey->CheckClaim(writer_id, now));
  // First on disk: what is in memory is durable.
  if (journey->record().writer_id != writer_id) {
    HOMING_RETURN_IF_ERROR(store_->SetWriter(name, writer_id));
  }
  HOMING_ASSIGN_OR_RETURN(const std::uint64_t claim,
                          journey->Claim(writer_id, now, std::move(evict)));
  return WriterClaim{std::move(journey), claim};
}

}  // namespace homing::server
