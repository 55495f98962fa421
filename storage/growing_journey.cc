#include "storage/growing_journey.h"

#include <algorithm>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"
#include "storage/row_words.h"
#include "storage/store_errors.h"

namespace homing::storage {
namespace {

// Steps whose landmarks are kept: more than the longest track gap.
constexpr std::int64_t kStepsSeen = 24;

absl::Status CheckContinues(const GrowingJourney& journey, const JourneyAppend& append) {
  if (journey.state != JourneyState::kActive) return JourneyIsFinished(append.journey);
  if (append.epoch != journey.epoch) {
    return absl::AbortedError(absl::StrCat("journey '", append.journey,
                                           "' was taken over by another writer (epoch ",
                                           journey.epoch, ", not ", append.epoch, ")"));
  }
  if (append.sequence != journey.next_sequence) {
    return absl::OutOfRangeError(absl::StrCat("sequence: ", append.sequence, " must be ",
                                              journey.next_sequence, ", the next of journey '",
                                              append.journey, "'"));
  }
  if (journey.input != InputKind::kUnknown && append.input != InputKind::kUnknown &&
      journey.input != append.input) {
    return absl::FailedPreconditionError(
        absl::StrCat("input: ", Word(append.input), " must be ", Word(journey.input),
                     ", as before in journey '", append.journey, "'"));
  }
  return absl::OkStatus();
}

// DATA_LOSS: no step holds it.
absl::StatusOr<Side> SideOf(GrowingJourney& journey, std::int32_t landmark,
                            const SideFinder& find) {
  if (const auto known = journey.seen.find(landmark); known != journey.seen.end()) {
    return known->second.side;
  }
  HOMING_ASSIGN_OR_RETURN(const std::optional<Side> side, find(journey, landmark));
  if (!side) {
    return absl::DataLossError(absl::StrCat("store: landmark ", landmark, " is in no step"));
  }
  journey.seen[landmark] = {*side, journey.step_count};
  return *side;
}

// Each landmark appears once, and is known with that side or has the next number.
absl::Status CheckLandmark(GrowingJourney& journey, const RecordedFingerprint& recorded,
                           const SideFinder& find, std::set<std::int32_t>& seen) {
  const std::int32_t landmark = recorded.fingerprint.landmark;
  const auto first_new = seen.lower_bound(journey.landmark_count);
  const std::int64_t due = journey.landmark_count + std::distance(first_new, seen.end());
  if (landmark < 0 || landmark > due || !seen.insert(landmark).second) {
    return MustBe("landmark", landmark, absl::StrCat("in [0, ", due, "], once in a step"));
  }
  if (landmark >= journey.landmark_count) return absl::OkStatus();
  HOMING_ASSIGN_OR_RETURN(const Side side, SideOf(journey, landmark, find));
  if (side != recorded.side) {
    return MustBe(absl::StrCat("side of landmark ", landmark), Word(recorded.side),
                  absl::StrCat(Word(side), ", where it was met"));
  }
  return absl::OkStatus();
}

absl::Status CheckStep(GrowingJourney& journey, const JourneyStep& step, std::int64_t sequence,
                       const SideFinder& find) {
  const std::int64_t last = std::min(sequence, kMostSteps - 1);
  if (step.step < journey.step_count || step.step > last) {
    return MustBe("step", step.step, absl::StrCat("in [", journey.step_count, ", ", last, "]"));
  }
  const std::int64_t least = journey.last_sequence + 1 + step.step - journey.step_count;
  HOMING_RETURN_IF_ERROR(CheckStepSequence(step, least));
  HOMING_RETURN_IF_ERROR(CheckFingerprints(step));
  std::set<std::int32_t> seen;
  for (const RecordedFingerprint& recorded : step.fingerprints) {
    HOMING_RETURN_IF_ERROR(CheckLandmark(journey, recorded, find, seen));
  }
  return absl::OkStatus();
}

void AddStep(GrowingJourney& journey, const JourneyStep& step, std::int64_t capture_time_ns) {
  for (const RecordedFingerprint& recorded : step.fingerprints) {
    const std::int32_t landmark = recorded.fingerprint.landmark;
    journey.seen[landmark] = {recorded.side, step.step};
    if (landmark == journey.landmark_count) ++journey.landmark_count;
  }
  std::erase_if(journey.seen,
                [&](const auto& seen) { return seen.second.step < step.step - kStepsSeen; });
  const bool is_first = journey.last_sequence < 0;
  const std::int64_t following =
      (is_first ? 1 : journey.last_sequence + 1) + step.step - journey.step_count;
  journey.last_sequence = step.sequence == kNextSequence ? following : step.sequence;
  journey.step_count = step.step + 1;
  journey.new_fingerprints += static_cast<std::int64_t>(step.fingerprints.size());
  // An observation without a step does not change the times, so that frames and the flow between
  // them agree.
  if (capture_time_ns != 0) {
    journey.last_time_ns = capture_time_ns;
    if (journey.first_time_ns == 0) journey.first_time_ns = capture_time_ns;
  }
}

}  // namespace

absl::Status Grow(GrowingJourney& journey, const JourneyAppend& append, const SideFinder& find) {
  HOMING_RETURN_IF_ERROR(CheckContinues(journey, append));
  if (append.step) {
    HOMING_RETURN_IF_ERROR(CheckStep(journey, *append.step, append.sequence, find));
    AddStep(journey, *append.step, append.capture_time_ns);
  }
  if (append.input != InputKind::kUnknown) journey.input = append.input;
  if (append.settings) journey.new_settings = append.settings;
  journey.next_sequence = append.sequence + 1;
  journey.resend_from = append.resend_from;
  return absl::OkStatus();
}

void GrowRecord(JourneyRecord& record, const JourneyAppend& append) {
  record.next_sequence = append.sequence + 1;
  record.resend_from = append.resend_from;
  if (append.input != InputKind::kUnknown) record.input = append.input;
  if (append.settings) record.settings = *append.settings;
  if (!append.step) return;
  const JourneyStep& step = *append.step;
  record.step_count = std::max(record.step_count, step.step + 1);
  record.fingerprint_count += static_cast<std::int64_t>(step.fingerprints.size());
  for (const RecordedFingerprint& recorded : step.fingerprints) {
    record.landmark_count = std::max(record.landmark_count, recorded.fingerprint.landmark + 1);
  }
  if (append.capture_time_ns != 0) {
    record.end_time_ns = append.capture_time_ns;
    if (record.start_time_ns == 0) record.start_time_ns = append.capture_time_ns;
  }
}

void MarkWritten(GrowingJourney& journey) {
  journey.first_time_ns = 0;
  journey.last_time_ns = 0;
  journey.new_fingerprints = 0;
  journey.new_settings.reset();
  journey.is_changed = false;
}

}  // namespace homing::storage
