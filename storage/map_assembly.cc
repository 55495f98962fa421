#include "storage/map_assembly.h"

#include <limits>
#include <string>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"

namespace homing::storage {
namespace {

absl::Status Contradiction(const JourneyRecord& record, const std::string& what) {
  return absl::DataLossError(absl::StrCat("store: journey '", record.name, "' is damaged: ", what));
}

absl::Status CheckStepCount(const JourneyRecord& record) {
  return record.step_count < 0 || record.step_count > kMostSteps
             ? Contradiction(record, absl::StrCat("step_count is ", record.step_count))
             : absl::OkStatus();
}

// The next step that has a row, checked against the record.
absl::StatusOr<std::optional<JourneyStep>> CheckedNext(const StepReader& next,
                                                       const JourneyRecord& record) {
  absl::StatusOr<std::optional<JourneyStep>> step = next();
  if (absl::IsInvalidArgument(step.status()) || absl::IsDataLoss(step.status())) {
    return Contradiction(record, std::string(step.status().message()));
  }
  if (!step.ok() || !*step) return step;
  if ((*step)->step >= record.step_count) {
    return Contradiction(record,
                         absl::StrCat("it has step ", (*step)->step, " of ", record.step_count));
  }
  for (const RecordedFingerprint& recorded : (*step)->fingerprints) {
    const std::int32_t landmark = recorded.fingerprint.landmark;
    if (landmark < 0 || landmark >= record.landmark_count) {
      return Contradiction(
          record, absl::StrCat("it has landmark ", landmark, " of ", record.landmark_count));
    }
  }
  return step;
}

absl::Status CheckCounts(const JourneyMap& map, const JourneyRecord& record) {
  const auto check = [&](const char* what, std::size_t found, std::int64_t counted) {
    return static_cast<std::int64_t>(found) == counted
               ? absl::OkStatus()
               : Contradiction(record,
                               absl::StrCat("it has ", found, " ", what, ", not ", counted));
  };
  HOMING_RETURN_IF_ERROR(check("landmarks", map.landmarks().size(), record.landmark_count));
  return check("fingerprints", map.all_fingerprints().size(), record.fingerprint_count);
}

// Numbers and times that no journey with this map has.
absl::Status CheckNumbers(const JourneyMap& map, const JourneyRecord& record) {
  const auto check = [&](const char* what, std::int64_t value, std::int64_t least,
                         std::int64_t most = std::numeric_limits<std::int64_t>::max()) {
    return value >= least && value <= most
               ? absl::OkStatus()
               : Contradiction(record, absl::StrCat(what, " is ", value));
  };
  // Each step took an observation.
  HOMING_RETURN_IF_ERROR(check("next_sequence", record.next_sequence, map.step_count()));
  HOMING_RETURN_IF_ERROR(check("resend_from", record.resend_from, 0, record.next_sequence));
  HOMING_RETURN_IF_ERROR(check("create_time_ns", record.create_time_ns, 0));
  HOMING_RETURN_IF_ERROR(check("start_time_ns", record.start_time_ns, 0));
  return check("end_time_ns", record.end_time_ns, 0);
}

}  // namespace

absl::StatusOr<JourneyMap> AssembleMap(const JourneyRecord& record, const StepReader& next) {
  HOMING_RETURN_IF_ERROR(CheckStepCount(record));
  JourneyMap map(record.settings);
  while (true) {
    HOMING_ASSIGN_OR_RETURN(const std::optional<JourneyStep> step, CheckedNext(next, record));
    if (!step) break;
    const absl::Status status = map.Append(*step);
    if (!status.ok()) return Contradiction(record, std::string(status.message()));
  }
  map.ExtendTo(record.step_count);
  HOMING_RETURN_IF_ERROR(CheckCounts(map, record));
  HOMING_RETURN_IF_ERROR(CheckNumbers(map, record));
  return map;
}

absl::StatusOr<JourneyTail> AssembleTail(const JourneyRecord& record, std::int64_t last_sequence,
                                         const StepReader& next) {
  JourneyTail tail{record.step_count, record.landmark_count, last_sequence, {}};
  HOMING_ASSIGN_OR_RETURN(tail.steps, AssembleSteps(record, next));
  return tail;
}

absl::StatusOr<std::vector<JourneyStep>> AssembleSteps(const JourneyRecord& record,
                                                       const StepReader& next) {
  HOMING_RETURN_IF_ERROR(CheckStepCount(record));
  std::vector<JourneyStep> steps;
  while (true) {
    HOMING_ASSIGN_OR_RETURN(std::optional<JourneyStep> step, CheckedNext(next, record));
    if (!step) return steps;
    steps.push_back(*std::move(step));
  }
}

// Each step gets the landmark's mean spread: a running mean of equal values is that value, to the
// bit.
JourneyStep StepOfMap(const JourneyMap& map, std::int64_t number) {
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
  return step;
}

std::int64_t LastSequence(std::int64_t step, std::int64_t sequence, std::int64_t step_count) {
  // Steps without one follow the step before.
  return sequence + step_count - 1 - step;
}

JourneyRecord EmptyRecord(const JourneyRecord& record) {
  JourneyRecord empty = record;
  empty.step_count = 0;
  empty.landmark_count = 0;
  empty.fingerprint_count = 0;
  return empty;
}

JourneyRecord FinishedRecord(const JourneyRecord& record, const JourneyMap& map) {
  JourneyRecord finished = record;
  finished.state = JourneyState::kFinished;
  finished.step_count = map.step_count();
  finished.landmark_count = static_cast<std::int32_t>(map.landmarks().size());
  finished.fingerprint_count = static_cast<std::int64_t>(map.all_fingerprints().size());
  return finished;
}

}  // namespace homing::storage
