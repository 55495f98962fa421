#include "storage/map_rows.h"

#include <string>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "storage/step_rows.h"

namespace homing::storage {
namespace {

absl::Status Contradiction(const JourneyRow& journey, const std::string& what) {
  return absl::DataLossError(
      absl::StrCat("store: journey '", journey.record.name, "' is damaged: ", what));
}

absl::Status CheckStepCount(const JourneyRow& journey) {
  const std::int64_t step_count = journey.record.step_count;
  return step_count < 0 || step_count > kMostSteps
             ? Contradiction(journey, absl::StrCat("step_count is ", step_count))
             : absl::OkStatus();
}

// The next step that has a row.
absl::StatusOr<JourneyStep> ReadNext(Query& row, const JourneyRow& journey) {
  absl::StatusOr<JourneyStep> step = ReadStep(row);
  if (!step.ok()) return Contradiction(journey, std::string(step.status().message()));
  if (step->step >= journey.record.step_count) {
    return Contradiction(
        journey, absl::StrCat("it has step ", step->step, " of ", journey.record.step_count));
  }
  for (const RecordedFingerprint& recorded : step->fingerprints) {
    const std::int32_t landmark = recorded.fingerprint.landmark;
    if (landmark < 0 || landmark >= journey.record.landmark_count) {
      return Contradiction(journey, absl::StrCat("it has landmark ", landmark, " of ",
                                                 journey.record.landmark_count));
    }
  }
  return step;
}

absl::Status CheckCounts(const JourneyMap& map, const JourneyRow& journey) {
  const auto check = [&](const char* what, std::size_t found, std::int64_t counted) {
    return static_cast<std::int64_t>(found) == counted
               ? absl::OkStatus()
               : Contradiction(journey,
                               absl::StrCat("it has ", found, " ", what, ", not ", counted));
  };
  HOMING_RETURN_IF_ERROR(check("landmarks", map.landmarks().size(), journey.record.landmark_count));
  return check("fingerprints", map.all_fingerprints().size(), journey.record.fingerprint_count);
}

}  // namespace

absl::StatusOr<JourneyMap> ReadMap(Connection& connection, const JourneyRow& journey) {
  HOMING_RETURN_IF_ERROR(CheckStepCount(journey));
  JourneyMap map(journey.record.settings);
  Query row = SelectSteps(connection, journey.id, 0);
  while (row.Next()) {
    HOMING_ASSIGN_OR_RETURN(const JourneyStep step, ReadNext(row, journey));
    const absl::Status status = map.Append(step);
    if (!status.ok()) return Contradiction(journey, std::string(status.message()));
  }
  map.ExtendTo(journey.record.step_count);
  HOMING_RETURN_IF_ERROR(CheckCounts(map, journey));
  return map;
}

absl::StatusOr<JourneyTail> ReadTail(Connection& connection, const JourneyRow& journey) {
  const JourneyRecord& record = journey.record;
  HOMING_RETURN_IF_ERROR(CheckStepCount(journey));
  JourneyTail tail{record.step_count,
                   record.landmark_count,
                   FindLastSequence(connection, journey.id, record.step_count),
                   {}};
  Query row =
      SelectSteps(connection, journey.id, FirstTailStep(record.settings, record.step_count));
  while (row.Next()) {
    HOMING_ASSIGN_OR_RETURN(tail.steps.emplace_back(), ReadNext(row, journey));
  }
  return tail;
}

// Each step gets the landmark's mean spread: a running mean of equal values is that value, to the
// bit.
void WriteMap(Connection& connection, std::int64_t journey_id, const JourneyMap& map) {
  for (std::int64_t number = 0; number < map.step_count(); ++number) {
    JourneyStep step;
    step.step = number;
    step.sequence = map.sequence(number);
    for (const Fingerprint& fingerprint : map.fingerprints(number)) {
      step.fingerprints.push_back(
          {map.side_of(fingerprint), fingerprint,
           map.landmarks()[static_cast<std::size_t>(fingerprint.landmark)].spread});
    }
    for (const Side side : {Side::kLeft, Side::kRight}) {
      const auto profiles = map.profiles(side);
      if (!profiles.empty()) {
        step.profiles[static_cast<std::size_t>(side)] = profiles[static_cast<std::size_t>(number)];
      }
    }
    InsertStep(connection, journey_id, step);
  }
}

}  // namespace homing::storage
