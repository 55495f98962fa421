// Which journeys a query is compared with: those whose camera and settings agree with it.
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

// What is known of the robot that asks.
struct QueryRobot {
  Travel travel = Travel::kReturn;
  // As the robot says, by Side of the ROBOT; absent: those of the journey.
  std::array<std::optional<Camera>, 2> cameras;
  // Sizes of the images it sends, pixels; 0: not known.
  std::array<int, 2> widths{};
  std::array<int, 2> heights{};
};

struct JourneySelection {
  // In order of name.
  LiveJourneys journeys;
  // travel, cameras, flow and landmark set; the rest as by default.
  LocalizerOptions options;
};

// Of the journeys covered by `pattern`. A named one must agree: FAILED_PRECONDITION. With a
// wildcard, those whose image sizes differ are skipped; then those whose settings are not the
// most frequent ones (ties: the first in order of name) are. FAILED_PRECONDITION: none is left.
absl::StatusOr<JourneySelection> SelectJourneys(const LiveJourneys& covered,
                                                const JourneyName& pattern,
                                                const QueryRobot& robot);

// Settings, and how many of the journeys covered have them.
struct SettingsUse {
  const JourneySettings* settings = nullptr;
  std::int64_t journeys = 0;
  // Of those journeys, in order of name. Empty: not known.
  std::string first_name;
};

struct SettingsSelection {
  // As in JourneySelection.
  LocalizerOptions options;
  // By the order of the uses given: whether journeys of these settings are chosen.
  std::vector<bool> chosen;
  // Others are as frequent: the first names decide.
  bool is_tie = false;
};

// The choice of SelectJourneys for a wildcard, from counts alone. NOT_FOUND: no journeys;
// FAILED_PRECONDITION: none is left.
absl::StatusOr<SettingsSelection> SelectSettings(const std::vector<SettingsUse>& uses,
                                                 const QueryRobot& robot);

}  // namespace homing::server

#endif  // SERVER_CATALOG_JOURNEY_SELECTION_H_
