// Selects the journeys that a query is compared with: those whose camera and settings match.
#ifndef SERVER_CATALOG_JOURNEY_SELECTION_H_
#define SERVER_CATALOG_JOURNEY_SELECTION_H_

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "homing/localization/localizer.h"
#include "server/catalog/journey_catalog.h"

namespace homing::server {

// The robot that sends the query.
struct QueryRobot {
  Travel travel = Travel::kReturn;
  // As the request gives them, by Side of the ROBOT; absent: the journey's.
  std::array<std::optional<Camera>, 2> cameras;
  // Sizes of the images it sends, pixels; 0: unknown.
  std::array<int, 2> widths{};
  std::array<int, 2> heights{};
};

struct JourneySelection {
  // In order of name.
  LiveJourneys journeys;
  // Sets travel, cameras, flow and landmark; the rest has its default.
  LocalizerOptions options;
};

// Selects among the journeys that `pattern` covers. A named journey must match:
// FAILED_PRECONDITION. A wildcard skips journeys with other image sizes, then those whose settings
// are not the most frequent ones (a tie: the first in order of name). FAILED_PRECONDITION: none is
// left.
absl::StatusOr<JourneySelection> SelectJourneys(const LiveJourneys& covered,
                                                const JourneyName& pattern,
                                                const QueryRobot& robot);

// Settings, and the number of covered journeys that have them.
struct SettingsUse {
  const JourneySettings* settings = nullptr;
  std::int64_t journeys = 0;
  // The first of these journeys in order of name. Empty: unknown.
  std::string first_name;
};

struct SettingsSelection {
  // As in JourneySelection.
  LocalizerOptions options;
  // Indexed as the uses given: journeys of these settings are selected.
  std::vector<bool> chosen;
  // Other settings are as frequent: the first names decide.
  bool is_tie = false;
};

// The selection of SelectJourneys for a wildcard, from counts alone. NOT_FOUND: no journeys;
// FAILED_PRECONDITION: none is left.
absl::StatusOr<SettingsSelection> SelectSettings(const std::vector<SettingsUse>& uses,
                                                 const QueryRobot& robot);

}  // namespace homing::server

#endif  // SERVER_CATALOG_JOURNEY_SELECTION_H_
