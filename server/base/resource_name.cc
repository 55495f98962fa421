#include "server/base/resource_name.h"

#include <algorithm>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"

namespace homing::server {
namespace {

constexpr std::size_t kMaxIdLength = 63;

bool IsIdCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
         c == '_' || c == '-';
}

absl::Status CheckIdOrWildcard(const std::string& id, const std::string& field) {
  return id == kWildcard ? absl::OkStatus() : CheckId(id, field);
}

}  // namespace

std::string JourneyName::ToString() const {
  return absl::StrCat("robots/", robot, "/journeys/", journey);
}

absl::Status CheckId(const std::string& id, const std::string& field) {
  if (id.empty() || id.size() > kMaxIdLength || id == kWildcard ||
      !std::all_of(id.begin(), id.end(), IsIdCharacter)) {
    return TextMustBe(field, id, "1 to 63 of [a-zA-Z0-9._-] and not \"-\"");
  }
  return absl::OkStatus();
}

absl::Status CheckNewId(const std::string& id, const std::string& field) {
  HOMING_RETURN_IF_ERROR(CheckId(id, field));
  if (id[0] == '.' || id[0] == '-') {
    return TextMustBe(
        field, id, "1 to 63 of [a-zA-Z0-9._-], of which the first is a letter, a digit or \"_\"");
  }
  return absl::OkStatus();
}

absl::Status CheckNewJourney(const JourneyName& name, const std::string& robot_field,
                             const std::string& journey_field) {
  HOMING_RETURN_IF_ERROR(CheckNewId(name.robot, robot_field));
  return CheckNewId(name.journey, journey_field);
}

absl::StatusOr<JourneyName> ParseJourneyPattern(const std::string& name, const std::string& field) {
  const std::vector<std::string> parts = absl::StrSplit(name, '/');
  if (parts.size() != 4 || parts[0] != "robots" || parts[2] != "journeys") {
    return TextMustBe(field, name, "\"robots/{robot}/journeys/{journey}\"");
  }
  HOMING_RETURN_IF_ERROR(CheckIdOrWildcard(parts[1], field));
  HOMING_RETURN_IF_ERROR(CheckIdOrWildcard(parts[3], field));
  return JourneyName{parts[1], parts[3]};
}

absl::StatusOr<JourneyName> ParseJourneyName(const std::string& name, const std::string& field) {
  absl::StatusOr<JourneyName> parsed = ParseJourneyPattern(name, field);
  if (parsed.ok() && parsed->is_pattern()) {
    return TextMustBe(field, name, "one journey; the wildcard \"-\" is not allowed here");
  }
  return parsed;
}

absl::StatusOr<std::string> ParseRobotName(const std::string& name, const std::string& field,
                                           bool wildcard_allowed) {
  const std::vector<std::string> parts = absl::StrSplit(name, '/');
  if (parts.size() != 2 || parts[0] != "robots") {
    return TextMustBe(field, name, "\"robots/{robot}\"");
  }
  HOMING_RETURN_IF_ERROR(wildcard_allowed ? CheckIdOrWildcard(parts[1], field)
                                          : CheckId(parts[1], field));
  return parts[1];
}

absl::StatusOr<std::string> ParseModelName(const std::string& name, const std::string& field) {
  const std::vector<std::string> parts = absl::StrSplit(name, '/');
  if (parts.size() != 2 || parts[0] != "deviationModels") {
    return TextMustBe(field, name, "\"deviationModels/{model}\"");
  }
  HOMING_RETURN_IF_ERROR(CheckId(parts[1], field));
  return parts[1];
}

bool Covers(const JourneyName& pattern, const JourneyName& name) {
  return (pattern.robot == kWildcard || pattern.robot == name.robot) &&
         (pattern.journey == kWildcard || pattern.journey == name.journey);
}

}  // namespace homing::server
