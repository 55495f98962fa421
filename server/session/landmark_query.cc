#include "server/session/landmark_query.h"

#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"
#include "homing/journey/see_landmarks.h"
#include "server/catalog/fleet_index.h"

namespace homing::server {
namespace {

constexpr std::size_t kMaxFingerprints = 100;

absl::Status CheckFingerprints(const SeenFingerprints& seen) {
  if (seen.landmarks.size() > kMaxFingerprints) {
    return MustBe("fingerprints", seen.landmarks.size(),
                  absl::StrCat("at most ", kMaxFingerprints, " entries"));
  }
  for (const SeenLandmark& landmark : seen.landmarks) {
    if (!std::isfinite(landmark.x) || !std::isfinite(landmark.y) || landmark.count < 0) {
      return MustBe("fingerprints",
                    absl::StrCat("x ", landmark.x, ", y ", landmark.y, ", count ", landmark.count),
                    "finite, with a count of at least 0");
    }
  }
  return absl::OkStatus();
}

// "left.frames.first".
std::string FramePath(std::size_t side, const char* which) {
  return absl::StrCat(kCameraNames[side], ".frames.", which);
}

// The sizes of the views' images; of a pair of frames, the size of the first.
absl::StatusOr<QueryRobot> MeasureRobot(const LandmarkQuery& query, const DecodeLimits& limits) {
  QueryRobot robot;
  robot.travel = query.travel;
  for (std::size_t side = 0; side < query.views.size(); ++side) {
    if (const auto* pair = std::get_if<FramePair>(&query.views[side])) {
      const auto size = MeasureGray(pair->first, limits);
      HOMING_RETURN_IF_ERROR(Renamed(size.status(), "frame", FramePath(side, "first")));
      robot.widths[side] = size->width;
      robot.heights[side] = size->height;
    } else if (const auto* flow = std::get_if<FlowField>(&query.views[side])) {
      robot.widths[side] = flow->width;
      robot.heights[side] = flow->height;
    } else if (const auto* seen = std::get_if<SeenFingerprints>(&query.views[side])) {
      HOMING_RETURN_IF_ERROR(Within(kCameraNames[side], CheckFingerprints(*seen)));
      robot.widths[side] = seen->width;
      robot.heights[side] = seen->height;
    }
  }
  return robot;
}

// The raw flow of one camera (II-B); none for fingerprints and for an absent camera.
absl::StatusOr<ObservedFlow> FlowOf(const QueryView& view, std::size_t side,
                                    const FlowOptions& options, const DecodeLimits& limits) {
  ObservationFlow tracker(options, limits);
  Observation observation;
  if (const auto* pair = std::get_if<FramePair>(&view)) {
    observation.views[side] = pair->first;
    HOMING_RETURN_IF_ERROR(Renamed(tracker.Compute(observation).status(),
                                   absl::StrCat(kCameraNames[side], ".frame"),
                                   FramePath(side, "first")));
    observation.views[side] = pair->second;
    observation.sequence = 1;
    auto flow_of_pair = tracker.Compute(observation);
    HOMING_RETURN_IF_ERROR(Renamed(flow_of_pair.status(),
                                   absl::StrCat(kCameraNames[side], ".frame"),
                                   FramePath(side, "second")));
    return flow_of_pair;
  }
  if (const auto* flow = std::get_if<FlowField>(&view)) {
    observation.views[side] = *flow;
    return tracker.Compute(observation);
  }
  return ObservedFlow();
}

struct SeenNow {
  std::optional<Motion> motion;
  SeenSides sides;
};

// Computes flow, motion and landmarks of the views, by side of the route.
absl::StatusOr<SeenNow> See(const LandmarkQuery& query, const LocalizerOptions& options,
                            const DecodeLimits& limits) {
  SeenNow now;
  ObservedFlow flow;
  for (std::size_t side = 0; side < query.views.size(); ++side) {
    HOMING_ASSIGN_OR_RETURN(ObservedFlow raw,
                            FlowOf(query.views[side], side, options.flow, limits));
    if (raw.fields[side]) {
      flow.fields[side] = std::move(raw.fields[side]);
      flow.makes_step = flow.makes_step || raw.makes_step;
    }
  }
  if (flow.fields[0] || flow.fields[1]) {
    SeenStep step = SeeLandmarks(flow, options.cameras, query.travel, options.landmark);
    now.motion = step.motion;
    now.sides = std::move(step.landmarks);
  }
  for (std::size_t side = 0; side < query.views.size(); ++side) {
    if (const auto* seen = std::get_if<SeenFingerprints>(&query.views[side])) {
      const Side route = RouteSide(Side{static_cast<int>(side)}, query.travel);
      now.sides[static_cast<std::size_t>(route)] = seen->landmarks;
    }
  }
  return now;
}

bool IsAll(const JourneyName& pattern) {
  return pattern.robot == kWildcard && pattern.journey == kWildcard;
}

// The index cannot filter by caller: it serves callers that may read all.
bool UsesIndex(const JourneyCatalog& catalog, const LandmarkQuery& query,
               const JourneyName& pattern) {
  return catalog.index() != nullptr && IsAll(pattern) && !query.filter;
}

absl::StatusOr<LandmarkQueryResult> MatchAll(FleetIndex* index, const LandmarkQuery& query,
                                             const QueryRobot& robot, const DecodeLimits& limits) {
  HOMING_ASSIGN_OR_RETURN(const LocalizerOptions options, index->Select(robot));
  HOMING_ASSIGN_OR_RETURN(SeenNow now, See(query, options, limits));
  LandmarkQueryResult result{now.motion, {}, std::move(now.sides)};
  HOMING_ASSIGN_OR_RETURN(auto matches, index->Find(robot, result.seen, query.match));
  for (auto& [journey, match] : matches) {
    result.matches.push_back({std::move(journey), match});
  }
  return result;
}

}  // namespace

absl::StatusOr<QueryJourneys> LoadQueryJourneys(JourneyCatalog* catalog, const LandmarkQuery& query,
                                                const DecodeLimits& limits) {
  HOMING_ASSIGN_OR_RETURN(const JourneyName pattern, ParseJourneyPattern(query.journey, "journey"));
  HOMING_RETURN_IF_ERROR(Validate(query.match));
  if (query.views[0].index() == 0 && query.views[1].index() == 0) {
    return NoCameraError();
  }
  QueryJourneys journeys;
  HOMING_ASSIGN_OR_RETURN(journeys.robot, MeasureRobot(query, limits));
  if (UsesIndex(*catalog, query, pattern)) {
    return journeys;
  }
  HOMING_ASSIGN_OR_RETURN(const LiveJourneys covered,
                          catalog->Resolve(pattern, query.filter, limits.cancellation));
  HOMING_ASSIGN_OR_RETURN(journeys.selection, SelectJourneys(covered, pattern, journeys.robot));
  HOMING_RETURN_IF_ERROR(
      catalog->LoadMaps(pattern, &journeys.selection.journeys, limits.cancellation));
  return journeys;
}

absl::StatusOr<LandmarkQueryResult> MatchLandmarks(JourneyCatalog* catalog,
                                                   const LandmarkQuery& query,
                                                   const QueryJourneys& journeys,
                                                   const DecodeLimits& limits) {
  const JourneySelection& selection = journeys.selection;
  if (selection.journeys.empty()) {
    return MatchAll(catalog->index(), query, journeys.robot, limits);
  }
  HOMING_ASSIGN_OR_RETURN(SeenNow now, See(query, selection.options, limits));

  LandmarkQueryResult result{now.motion, {}, std::move(now.sides)};
  const MapsLock lock(selection.journeys);
  const std::vector<JourneyRef> refs = lock.refs();
  const auto matches = Matcher().Find(refs, result.seen, query.match, limits.cancellation);
  HOMING_RETURN_IF_ERROR(CheckAwaited(limits.cancellation));
  for (const Match& match : matches) {
    result.matches.push_back({*refs[static_cast<std::size_t>(match.journey)].name, match});
  }
  return result;
}

}  // namespace homing::server
