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
  // Either may be kWildcard in a pattern.
  std::string robot;
  std::string journey;

  bool is_pattern() const { return robot == kWildcard || journey == kWildcard; }
  std::string ToString() const;
};

// All: INVALID_ARGUMENT naming `field`, the value and what is allowed.

// 1 to 63 of [a-zA-Z0-9._-], not "-".
absl::Status CheckId(const std::string& id, const std::string& field);
absl::StatusOr<JourneyName> ParseJourneyName(const std::string& name, const std::string& field);
// Wildcards allowed.
absl::StatusOr<JourneyName> ParseJourneyPattern(const std::string& name, const std::string& field);
// "robots/{robot}" to the robot's id; "-" only where `wildcard_allowed`.
absl::StatusOr<std::string> ParseRobotName(const std::string& name, const std::string& field,
                                           bool wildcard_allowed);
// "deviationModels/{model}" to the model's id.
absl::StatusOr<std::string> ParseModelName(const std::string& name, const std::string& field);

// True if `name` is one that `pattern` covers.
bool Covers(const JourneyName& pattern, const JourneyName& name);

}  // namespace homing::server

#endif  // SERVER_BASE_RESOURCE_NAME_H_
