#include "server/access/authorization.h"

#include <algorithm>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "server/base/error_reason.h"
#include "server/base/resource_name.h"

namespace homing::server {
namespace {

absl::Status Denied(const Caller& caller, Rpc rpc, const std::string& resource) {
  const std::string_view method = TraitsOf(rpc).method;
  const std::string on = resource.empty() ? "" : absl::StrCat(" of \"", resource, "\"");
  return WithReason(
      absl::PermissionDeniedError(
          absl::StrCat(caller.identity, " (", NameOf(caller.role), ") is not allowed ",
                       std::string(method.substr(method.find('/') + 1)), on)),
      {"NOT_ALLOWED", {{"identity", caller.identity}, {"role", NameOf(caller.role)}}});
}

Standing StandingOf(const Caller& caller, const storage::JourneyRecord& record) {
  const std::string robot = caller.robot();
  if (!robot.empty() && absl::StartsWith(record.name, absl::StrCat("robots/", robot, "/"))) {
    return Standing::kOwner;
  }
  const bool listed = std::any_of(
      record.readers.begin(), record.readers.end(),
      [&](const std::string& reader) { return reader == "*" || reader == caller.identity; });
  return listed ? Standing::kReader : Standing::kOther;
}

// The resource that a request names.
struct Target {
  JourneyName name;
  // Only the robot is named.
  bool is_robot = false;
};

absl::StatusOr<Target> ParseTarget(Rpc rpc, const std::string& resource) {
  const std::string field(TraitsOf(rpc).field);
  if (rpc == Rpc::kCreateJourney || rpc == Rpc::kListJourneys || rpc == Rpc::kWatchRobot) {
    HOMING_ASSIGN_OR_RETURN(const std::string robot,
                            ParseRobotName(resource, field, rpc == Rpc::kListJourneys));
    return Target{{robot, kWildcard}, true};
  }
  const bool patterns = TraitsOf(rpc).right == Right::kLocalize;
  HOMING_ASSIGN_OR_RETURN(const JourneyName name, patterns ? ParseJourneyPattern(resource, field)
                                                           : ParseJourneyName(resource, field));
  return Target{name, false};
}

// The caller's relation to a resource by its name alone, without a lookup: owner or stranger.
Standing OwnerOrOther(const Caller& caller, const JourneyName& name) {
  return name.robot == caller.robot() ? Standing::kOwner : Standing::kOther;
}

}  // namespace

absl::Status Authorize(const Caller& caller, Rpc rpc, const std::string& resource,
                       JourneyCatalog* catalog) {
  const Right right = TraitsOf(rpc).right;
  if (AllowsAll(caller.role, right)) {
    return absl::OkStatus();
  }
  // The caller is refused for every resource.
  if (!Allows(caller.role, right, Standing::kOwner)) {
    return Denied(caller, rpc, resource);
  }
  // Without a resource the answer holds only what belongs to the caller.
  if (TraitsOf(rpc).field.empty()) {
    return absl::OkStatus();
  }
  HOMING_ASSIGN_OR_RETURN(const Target target, ParseTarget(rpc, resource));
  const bool reads = Allows(caller.role, right, Standing::kReader);
  if (reads && (target.is_robot || target.name.is_pattern())) {
    return absl::OkStatus();
  }
  if (Allows(caller.role, right, OwnerOrOther(caller, target.name))) {
    return absl::OkStatus();
  }
  if (reads) {
    const auto record = catalog->Get(target.name.ToString());
    if (record.ok() && Allows(caller.role, right, StandingOf(caller, *record))) {
      return absl::OkStatus();
    }
    // An unreadable store is reported; a missing journey is not, so that names cannot be guessed.
    if (!record.ok() && !absl::IsNotFound(record.status())) {
      return record.status();
    }
  }
  return Denied(caller, rpc, resource);
}

JourneyFilter JourneysFor(const Caller& caller, Rpc rpc) {
  const Right right = TraitsOf(rpc).right;
  if (AllowsAll(caller.role, right)) {
    return nullptr;
  }
  return [caller, right](const storage::JourneyRecord& record) {
    return Allows(caller.role, right, StandingOf(caller, record));
  };
}

bool SeesRobot(const Caller& caller, const std::string& robot) {
  const bool own = !caller.robot().empty() && robot == caller.identity;
  return Allows(caller.role, Right::kSeeFleet, own ? Standing::kOwner : Standing::kOther);
}

}  // namespace homing::server
