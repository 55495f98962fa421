#include "server/catalog/journey_catalog.h"

#include <functional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/mutex.h"
#include "homing/base/status_macros.h"
#include "server/base/error_reason.h"
#include "server/catalog/fleet_index.h"
#include "server/catalog/journey_errors.h"
#include "server/catalog/same_journey.h"

namespace homing::server {
namespace {

using storage::JourneyRecord;

constexpr int kListPage = 1000;

std::string PrefixOf(const std::string& robot) {
  return robot == kWildcard ? "robots/" : absl::StrCat("robots/", robot, "/journeys/");
}

absl::Status NoneCovered(const JourneyName& pattern) {
  return absl::NotFoundError(
      absl::StrCat("journey: \"", pattern.ToString(), "\" covers no journey"));
}

}  // namespace

Mutex& JourneyCatalog::StripeOf(const std::string& name) {
  return stripes_[std::hash<std::string>()(name) % stripes_.size()];
}

absl::StatusOr<std::shared_ptr<LiveJourney>> JourneyCatalog::OpenLocked(const std::string& name) {
  if (auto journey = cache_.Find(name)) {
    return journey;
  }
  HOMING_ASSIGN_OR_RETURN(JourneyRecord record, store_->GetJourney(name));
  auto journey = std::make_shared<LiveJourney>(std::move(record), store_, index_);
  cache_.Insert(name, journey);
  return journey;
}

absl::StatusOr<std::shared_ptr<LiveJourney>> JourneyCatalog::FindOrOpen(const std::string& name) {
  if (auto journey = cache_.Find(name)) {
    return journey;
  }
  const MutexLock lock(StripeOf(name));
  return OpenLocked(name);
}

absl::StatusOr<std::shared_ptr<LiveJourney>> JourneyCatalog::Open(const std::string& name) {
  HOMING_ASSIGN_OR_RETURN(auto journey, FindOrOpen(name));
  if (!journey->has_map()) {
    // The stripe is not held: loading a long map must not block a writer.
    HOMING_RETURN_IF_ERROR(journey->LoadMap());
    cache_.EvictUnused();
  }
  return journey;
}

absl::StatusOr<JourneyRecord> JourneyCatalog::GetSameOrExists(const JourneyRecord& record) {
  HOMING_ASSIGN_OR_RETURN(JourneyRecord present, Get(record.name));
  if (IsSameJourney(record, present)) {
    return present;
  }
  return absl::AlreadyExistsError(
      absl::StrCat("journey: \"", record.name,
                   "\" exists, and is finished, or has another writer_id, other settings or "
                   "other readers (SetReaders changes these)"));
}

absl::StatusOr<JourneyRecord> JourneyCatalog::Create(const JourneyRecord& record) {
  const MutexLock lock(StripeOf(record.name));
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
  // Memory may lag behind what another server has written.
  if (const auto journey = shared() ? nullptr : cache_.Find(name)) {
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
  const MutexLock lock(StripeOf(name));
  const auto journey = cache_.Find(name);
  if (journey) {
    journey->EvictWriter(JourneyDeleted(name));
  }
  HOMING_RETURN_IF_ERROR(store_->DeleteJourney(name));
  damaged_.Remove(name);
  if (index_ != nullptr) {
    index_->Deleted(name);
  }
  if (journey) {
    journey->MarkDeleted();
    cache_.Erase(name);
  }
  return absl::OkStatus();
}

absl::StatusOr<JourneyRecord> JourneyCatalog::Finish(const std::string& name,
                                                     const std::string& writer_id, bool force,
                                                     TimePoint now) {
  const MutexLock lock(StripeOf(name));
  if (!force) {
    HOMING_RETURN_IF_ERROR(store_->CheckLease(name, writer_id));
  }
  const auto journey = cache_.Find(name);
  if (journey) {
    if (!force) {
      HOMING_RETURN_IF_ERROR(writer_id.empty() ? journey->CheckNoStream(now)
                                               : journey->CheckWriter(writer_id, now));
    }
    journey->EvictWriter(JourneyFinished(name));
  }
  HOMING_RETURN_IF_ERROR(store_->FinishJourney(name));
  if (journey) {
    journey->MarkFinished();
  }
  return Get(name);
}

absl::StatusOr<JourneyRecord> JourneyCatalog::SetReaders(const std::string& name,
                                                         const std::vector<std::string>& readers) {
  const MutexLock lock(StripeOf(name));
  HOMING_RETURN_IF_ERROR(store_->SetReaders(name, readers));
  if (const auto journey = cache_.Find(name)) {
    journey->SetReaders(readers);
  }
  return Get(name);
}

absl::StatusOr<JourneyRecord> JourneyCatalog::Import(const JourneyRecord& record,
                                                     const JourneyMap& map) {
  const MutexLock lock(StripeOf(record.name));
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
  auto journey = FindOrOpen(name);
  if (!journey.ok()) {
    return IsSkipped(name, journey.status()) ? absl::OkStatus() : journey.status();
  }
  journeys->push_back(*std::move(journey));
  return absl::OkStatus();
}

absl::StatusOr<LiveJourneys> JourneyCatalog::Resolve(const JourneyName& pattern,
                                                     const JourneyFilter& filter,
                                                     const Cancellation* cancellation) {
  LiveJourneys journeys;
  if (!pattern.is_pattern()) {
    HOMING_ASSIGN_OR_RETURN(auto journey, FindOrOpen(pattern.ToString()));
    journeys.push_back(std::move(journey));
    return journeys;
  }
  std::string after;
  while (true) {
    HOMING_ASSIGN_OR_RETURN(const std::vector<JourneyRecord> page,
                            store_->ListJourneys(PrefixOf(pattern.robot), after, kListPage));
    for (const JourneyRecord& record : page) {
      HOMING_RETURN_IF_ERROR(CheckAwaited(cancellation));
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
    return NoneCovered(pattern);
  }
  return journeys;
}

bool JourneyCatalog::IsSkipped(const std::string& name, const absl::Status& status) {
  // The journey was deleted after it was listed.
  if (absl::IsNotFound(status)) return true;
  if (absl::IsDataLoss(status)) damaged_.Add(name, status);
  return absl::IsDataLoss(status);
}

absl::Status JourneyCatalog::LoadMap(const JourneyName& pattern, LiveJourney* journey) {
  if (journey->has_map()) {
    return absl::OkStatus();
  }
  HOMING_RETURN_IF_ERROR(journey->LoadMap());
  const std::int64_t bytes = cache_.EvictUnused();
  // A robot that names its journey is served at any size.
  if (pattern.is_pattern() && bytes > options_.cache_bytes) {
    return WithReason(
        absl::ResourceExhaustedError(absl::StrCat(
            "journey: \"", pattern.ToString(), "\" needs more memory for maps than map-cache, ",
            options_.cache_bytes, " bytes; name fewer journeys, or raise map-cache")),
        {"MAP_CACHE", {}});
  }
  return absl::OkStatus();
}

absl::Status JourneyCatalog::LoadMaps(const JourneyName& pattern, LiveJourneys* journeys,
                                      const Cancellation* cancellation) {
  LiveJourneys loaded;
  absl::Status last = NoneCovered(pattern);
  for (const std::shared_ptr<LiveJourney>& journey : *journeys) {
    HOMING_RETURN_IF_ERROR(CheckAwaited(cancellation));
    absl::Status status = LoadMap(pattern, journey.get());
    if (status.ok()) {
      loaded.push_back(journey);
    } else if (!pattern.is_pattern() || !IsSkipped(journey->name(), status)) {
      return status;
    } else if (absl::IsDataLoss(status)) {
      last = status;
    }
  }
  if (loaded.empty()) {
    return last;
  }
  *journeys = std::move(loaded);
  return absl::OkStatus();
}

absl::StatusOr<WriterClaim> JourneyCatalog::Claim(const std::string& name,
                                                  const std::string& writer_id, TimePoint now,
                                                  WriterLease::Evict evict) {
  if (store_->read_only()) {
    return absl::FailedPreconditionError("the server is read-only: it records nothing");
  }
  const MutexLock lock(StripeOf(name));
  auto journey = cache_.Find(name);
  if (!journey) {
    HOMING_ASSIGN_OR_RETURN(journey, OpenLocked(name));
    cache_.EvictUnused();
  }
  cache_.SetTime(now);
  HOMING_RETURN_IF_ERROR(journey->CheckClaim(writer_id, now));
  HOMING_ASSIGN_OR_RETURN(const LiveClaim claim, journey->Claim(writer_id, now, std::move(evict)));
  return WriterClaim{std::move(journey), claim.number, claim.epoch};
}

void JourneyCatalog::Drop(const std::shared_ptr<LiveJourney>& journey) {
  const MutexLock lock(StripeOf(journey->name()));
  journey->EvictWriter(JourneyDeleted(journey->name()));
  journey->MarkDeleted();
  if (cache_.Find(journey->name()) == journey) {
    cache_.Erase(journey->name());
  }
}

}  // namespace homing::server
