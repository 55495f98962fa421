#include "server/catalog/journey_selection.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "server/base/error_reason.h"

namespace homing::server {
namespace {

struct Candidate {
  std::shared_ptr<LiveJourney> journey;
  LocalizerOptions options;
};

// The robot's own camera, or else the journey's: the robot that recorded it comes home. The sizes
// are those of the images it sends now.
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

// Journeys with equal settings, as seen by one robot.
struct Group {
  LocalizerOptions options;
  std::int64_t journeys = 0;
  std::string first_name;
  // Indices of their settings.
  std::vector<std::size_t> members;
};

bool IsMoreFrequent(const Group& a, const Group& b) {
  return a.journeys != b.journeys ? a.journeys > b.journeys : a.first_name < b.first_name;
}

void Count(const SettingsUse& use, std::size_t index, const LocalizerOptions& options,
           std::vector<Group>* groups) {
  auto group = std::find_if(groups->begin(), groups->end(), [&](const Group& known) {
    return SameSettings(known.options, options);
  });
  if (group == groups->end()) {
    group = groups->insert(groups->end(), Group{options, 0, use.first_name, {}});
  }
  group->journeys += use.journeys;
  group->first_name = std::min(group->first_name, use.first_name);
  group->members.push_back(index);
}

absl::Status NoneLeft(const JourneyName& pattern, std::int64_t covered, const absl::Status& last) {
  return WithReason(absl::FailedPreconditionError(absl::StrCat(
                        "journey: \"", pattern.ToString(), "\" covers ", covered,
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
    return NoneLeft(pattern, static_cast<std::int64_t>(covered.size()), last);
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

absl::StatusOr<SettingsSelection> SelectSettings(const std::vector<SettingsUse>& uses,
                                                 const QueryRobot& robot) {
  const JourneyName all{kWildcard, kWildcard};
  std::vector<Group> groups;
  std::int64_t journeys = 0;
  absl::Status last;
  for (std::size_t i = 0; i < uses.size(); ++i) {
    if (uses[i].journeys == 0) continue;
    journeys += uses[i].journeys;
    const LocalizerOptions options = OptionsFor(robot, *uses[i].settings);
    const absl::Status status = CheckCompatible(options, *uses[i].settings);
    if (status.ok()) {
      Count(uses[i], i, options, &groups);
    } else {
      last = status;
    }
  }
  if (journeys == 0) {
    return absl::NotFoundError(absl::StrCat("journey: \"", all.ToString(), "\" covers no journey"));
  }
  if (groups.empty()) {
    return NoneLeft(all, journeys, last);
  }
  const auto best = std::min_element(groups.begin(), groups.end(), IsMoreFrequent);
  SettingsSelection selection{best->options, std::vector<bool>(uses.size()), false};
  for (const std::size_t member : best->members) {
    selection.chosen[member] = true;
  }
  selection.is_tie = std::count_if(groups.begin(), groups.end(), [&](const Group& group) {
                       return group.journeys == best->journeys;
                     }) > 1;
  return selection;
}

}  // namespace homing::server
