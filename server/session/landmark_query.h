// Finds the stored landmarks that are similar to those in two frames, flow vectors or fingerprints.
// Source: paper III (eqs 11 to 15).
#ifndef SERVER_SESSION_LANDMARK_QUERY_H_
#define SERVER_SESSION_LANDMARK_QUERY_H_

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "absl/status/statusor.h"
#include "homing/matching/matcher.h"
#include "server/catalog/journey_catalog.h"
#include "server/catalog/journey_selection.h"

namespace homing::server {

struct FramePair {
  Frame first;
  Frame second;
};

struct SeenFingerprints {
  // Size of the image they were found in, pixels; 0: not checked.
  int width = 0;
  int height = 0;
  std::vector<SeenLandmark> landmarks;
};

using QueryView = std::variant<std::monostate, FramePair, FlowField, SeenFingerprints>;

struct LandmarkQuery {
  // Name or pattern; `filter` selects journeys of a pattern.
  std::string journey;
  JourneyFilter filter;
  Travel travel = Travel::kReturn;
  // Indexed by Side of the ROBOT.
  std::array<QueryView, 2> views;
  MatchOptions match;
};

struct NamedMatch {
  std::string journey;
  Match match;
};

struct LandmarkQueryResult {
  // Absent if only fingerprints were given.
  std::optional<Motion> motion;
  std::vector<NamedMatch> matches;
  // Landmarks seen, by side of the ROUTE.
  SeenSides seen;
};

// What a query is compared with.
struct QueryJourneys {
  QueryRobot robot;
  // With their maps; empty where the index of all journeys answers.
  JourneySelection selection;
};

// Selects the journeys of a query and loads their maps: it may wait for the store.
// INVALID_ARGUMENT, NOT_FOUND, FAILED_PRECONDITION (other camera).
absl::StatusOr<QueryJourneys> LoadQueryJourneys(JourneyCatalog* catalog, const LandmarkQuery& query,
                                                const DecodeLimits& limits);

// Only computes. `journeys` are those of the query. INVALID_ARGUMENT; errors of the index of all
// journeys.
absl::StatusOr<LandmarkQueryResult> MatchLandmarks(JourneyCatalog* catalog,
                                                   const LandmarkQuery& query,
                                                   const QueryJourneys& journeys,
                                                   const DecodeLimits& limits);

}  // namespace homing::server

#endif  // SERVER_SESSION_LANDMARK_QUERY_H_
