#include "server/session/journey_selection.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "homing/status_macros.h"
#include "server/session/error_reason.h"

namespace homing::server {
namespace {

struct Candidate {
  std::shared_ptr<LiveJourney> journey;
  LocalizerOptions options;
};

// The robot's own camera, or that of the journey, whose left camera is the robot's left camera: the
// same robot comes home. Sizes are those of what it sends now.
Camera CameraOf(const QueryRobot& robot, const JourneySettings& settings, std::size_t side) {
  Camera camera = robot.cameras[side].value_or(settings.cameras[side]);
  if (!robot.cameras[side]) {
    camera.width = 0;
    camera.height = 0;
  }
  if (robot.widths[side] > 0) {
    camera.width = robot.widths[side];
    camera.height = robot.heights[side];
  }
  return camera;
}

LocalizerOptions OptionsFor(const QueryRobot& robot, const JourneySettings& settings) {
  LocalizerOptions options;
  options.travel = robot.travel;
  options.cameras = {CameraOf(robot, settings, 0), CameraOf(robot, settings, 1)};
  options.flow = settings.flow;
  options.landmark = settings.landmark;
  return options;
}

bool SameSettings(const LocalizerOptions& a, const LocalizerOptions& b) {
  return a.cameras == b.cameras && a.flow == b.flow && a.landmark == b.landmark;
}

LocalizerOptions MostFrequent(const std::vector<Candidate>& candidates) {
  std::vector<std::pair<const LocalizerOptions*, int>> groups;
  for (const Candidate& candidate : candidates) {
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& known) {
      return SameSettings(*known.first, candidate.options);
    });
    if (group == groups.end()) {
      groups.emplace_back(&candidate.options, 1);
    } else {
      ++group->second;
    }
  }
  return *std::max_element(groups.begin(), groups.end(), [](const auto& a, const auto& b) {
            return a.second < b.second;
          })->first;
}

absl::Status NoneLeft(const JourneyName& pattern, std::size_t covered, const absl::Status& last) {
  return WithReason(absl::FailedPreconditionError(absl::StrCat(
                        "journey is \"", pattern.ToString(), "\"; it covers ", covered,
                        " journeys, and none has the camera and settings of the query: ",
                        std::string(last.message()))),
                    {"OTHER_SETTINGS", {}});
}

}  // namespace

absl::StatusOr<JourneySelection> SelectJourneys(const LiveJourneys& covered,
                                                const JourneyName& pattern,
                                                const QueryRobot& robot) {
  std::vector<Candidate> candidates;
  absl::Status last;
  for (const std::shared_ptr<LiveJourney>& journey : covered) {
    const JourneySettings settings = journey->settings();
    const LocalizerOptions options = OptionsFor(robot, settings);
    const absl::Status status = CheckCompatible(options, settings);
    if (status.ok()) {
      candidates.push_back({journey, options});
    } else if (!pattern.is_pattern()) {
      return WithReason(status, {"OTHER_SETTINGS", {}});
    } else {
      last = status;
    }
  }
  if (candidates.empty()) {
    return NoneLeft(pattern, covered.size(), last);
  }
  JourneySelection selection;
  selection.options = MostFrequent(candidates);
  for (Candidate& candidate : candidates) {
    if (SameSettings(candidate.options, selection.options)) {
      selection.journeys.push_back(std::move(candidate.journey));
    }
  }
  return selection;
}

}  // namespace homing::server
