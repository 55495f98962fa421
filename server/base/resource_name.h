// Names of resources: "robots/{robot}/journeys/{journey}", "deviationModels/{model}"; "-" is the
// wildcard.
#ifndef SERVER_BASE_RESOURCE_NAME_H_
#define SERVER_BASE_RESOURCE_NAME_H_

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace homing::server {

inline constexpr char kWildcard[] = "-";

struct JourneyName {
  // In a pattern, either may be kWildcard.
  std::string robot;
  std::string journey;

  bool is_pattern() const { return robot == kWildcard || journey == kWildcard; }
  std::string ToString() const;
};

// Each returns INVALID_ARGUMENT with `field`, the value and the allowed form.

// 1 to 63 of [a-zA-Z0-9._-], not "-".
absl::Status CheckId(const std::string& id, const std::string& field);
// Of a resource that is created: also, the first one is a letter, a digit or "_". Exported files,
// URLs and shells read ".", ".." and "-x" as something else. What exists keeps its name.
absl::Status CheckNewId(const std::string& id, const std::string& field);
// Both ids of a journey that is created.
absl::Status CheckNewJourney(const JourneyName& name, const std::string& robot_field,
                             const std::string& journey_field);
absl::StatusOr<JourneyName> ParseJourneyName(const std::string& name, const std::string& field);
// Wildcards allowed.
absl::StatusOr<JourneyName> ParseJourneyPattern(const std::string& name, const std::string& field);
// The robot's id in "robots/{robot}"; "-" only if `wildcard_allowed`.
absl::StatusOr<std::string> ParseRobotName(const std::string& name, const std::string& field,
                                           bool wildcard_allowed);
// The model's id in "deviationModels/{model}".
absl::StatusOr<std::string> ParseModelName(const std::string& name, const std::string& field);

// `pattern` covers `name`.
bool Covers(const JourneyName& pattern, const JourneyName& name);

}  // namespace homing::server

#endif  // SERVER_BASE_RESOURCE_NAME_H_
