#include "server/catalog/journey_follower.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "homing/base/status_macros.h"

namespace homing::server {

JourneyFollower::JourneyFollower(storage::JourneyStore* store, JourneyCatalog* catalog)
    : store_(store), catalog_(catalog), thread_([this] {
        // StoreWatch reports a store that does not answer.
        FollowAll().IgnoreError();
        return kInterval;
      }) {}

absl::Status JourneyFollower::FollowAll() {
  const auto journeys = catalog_->InMemory();
  std::vector<std::string> names;
  names.reserve(journeys.size());
  for (const auto& [name, journey] : journeys) names.push_back(name);
  if (names.empty()) return absl::OkStatus();
  HOMING_ASSIGN_OR_RETURN(const std::vector<storage::JourneyMark> marks, store_->LoadMarks(names));
  std::map<std::string, const storage::JourneyMark*> stored;
  for (const storage::JourneyMark& mark : marks) stored[mark.name] = &mark;
  for (const auto& [name, journey] : journeys) {
    const auto mark = stored.find(name);
    const bool is_same =
        mark != stored.end() && mark->second->create_time_ns == journey->record().create_time_ns;
    const absl::Status status =
        is_same ? journey->Follow(*mark->second) : absl::NotFoundError(name);
    if (absl::IsNotFound(status)) {
      catalog_->Drop(journey);
    } else {
      HOMING_RETURN_IF_ERROR(status);
    }
  }
  return absl::OkStatus();
}

}  // namespace homing::server
