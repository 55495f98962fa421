#include "storage/step_appends.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"
#include "storage/journey_rows.h"
#include "storage/row_words.h"
#include "storage/step_rows.h"

namespace homing::storage {
namespace {

constexpr char kFindActive[] =
    "SELECT journey_id, state, input, next_sequence, step_count, landmark_count,"
    " resend_from FROM journeys WHERE name = ?";
constexpr char kUpdate[] =
    "UPDATE journeys SET next_sequence = ?2, input = ?3,"
    " start_time_ns = CASE start_time_ns WHEN 0 THEN ?4 ELSE start_time_ns END,"
    " end_time_ns = CASE ?5 WHEN 0 THEN end_time_ns ELSE ?5 END,"
    " step_count = ?6, landmark_count = ?7, fingerprint_count = fingerprint_count + ?8,"
    " resend_from = ?9"
    " WHERE journey_id = ?1";

// Two a camera (paper III).
constexpr int kMaxFingerprintsPerSide = 2;
constexpr double kMaxSpread = 1e9;
// Journeys kept between transactions; a few hundred bytes each.
constexpr std::size_t kMostKept = 4096;

absl::Status CheckValues(const RecordedFingerprint& recorded) {
  const Fingerprint& fingerprint = recorded.fingerprint;
  if (!std::isfinite(fingerprint.x) || !std::isfinite(fingerprint.y)) {
    return MustBe(absl::StrCat("mean of landmark ", fingerprint.landmark),
                  absl::StrCat("(", fingerprint.x, ", ", fingerprint.y, ")"), "finite");
  }
  if (!(recorded.spread >= 0 && recorded.spread <= kMaxSpread)) {
    return MustBe(absl::StrCat("spread of landmark ", fingerprint.landmark), recorded.spread,
                  absl::StrCat("in [0, ", kMaxSpread, "]"));
  }
  if (fingerprint.count <= 0) {
    return MustBe(absl::StrCat("count of landmark ", fingerprint.landmark), fingerprint.count,
                  "at least 1");
  }
  return absl::OkStatus();
}

// Checks the order: left before right, at most two on a side.
absl::Status CheckOrder(const JourneyStep& step) {
  int left = 0;
  int right = 0;
  for (const RecordedFingerprint& recorded : step.fingerprints) {
    const bool is_left = recorded.side == Side::kLeft;
    if (is_left && right > 0) {
      return FieldError("fingerprints",
                        absl::StrCat("of step ", step.step, " must have left before right"));
    }
    if (++(is_left ? left : right) > kMaxFingerprintsPerSide) {
      return FieldError("fingerprints", absl::StrCat("of step ", step.step, " must be at most ",
                                                     kMaxFingerprintsPerSide, " on one side"));
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<StepAppends::JourneyColumns*> StepAppends::Find(const std::string& name) {
  if (const auto known = journeys_.find(name); known != journeys_.end()) return &known->second;
  Query query = connection_->Prepare(kFindActive, name);
  if (!query.Next()) return JourneyNotFound(name);
  JourneyColumns journey;
  journey.id = query.Integer(0);
  HOMING_ASSIGN_OR_RETURN(journey.state, StateOfWord(query.Text(1)));
  HOMING_ASSIGN_OR_RETURN(journey.input, InputOfWord(query.Text(2)));
  journey.next_sequence = query.Integer(3);
  journey.step_count = query.Integer(4);
  journey.landmark_count = static_cast<std::int32_t>(query.Integer(5));
  journey.resend_from = query.Integer(6);
  journey.last_sequence = FindLastSequence(*connection_, journey.id, journey.step_count);
  return &journeys_.emplace(name, std::move(journey)).first->second;
}

absl::StatusOr<Side> StepAppends::SideOf(JourneyColumns& journey, std::int32_t landmark) {
  FindSides(*connection_, journey.id, landmark, journey.sides);
  const auto found = journey.sides.find(landmark);
  if (found == journey.sides.end()) {
    return absl::DataLossError(absl::StrCat("store: landmark ", landmark, " is in no step"));
  }
  return found->second;
}

absl::Status StepAppends::CheckContinues(const JourneyColumns& journey,
                                         const JourneyAppend& append) {
  if (journey.state != JourneyState::kActive) {
    return absl::FailedPreconditionError(
        absl::StrCat("journey '", append.journey, "' is finished"));
  }
  if (append.sequence != journey.next_sequence) {
    return absl::OutOfRangeError(absl::StrCat("sequence is ", append.sequence, ": ",
                                              journey.next_sequence, " is due in journey '",
                                              append.journey, "'"));
  }
  if (journey.input != InputKind::kUnknown && append.input != InputKind::kUnknown &&
      journey.input != append.input) {
    return absl::FailedPreconditionError(absl::StrCat("input is ", Word(append.input),
                                                      ": journey '", append.journey,
                                                      "' is recorded from ", Word(journey.input)));
  }
  return absl::OkStatus();
}

// Each landmark appears once, and is known with that side or has the next number.
absl::Status StepAppends::CheckLandmark(JourneyColumns& journey,
                                        const RecordedFingerprint& recorded,
                                        std::set<std::int32_t>& seen) {
  const std::int32_t landmark = recorded.fingerprint.landmark;
  const auto first_new = seen.lower_bound(journey.landmark_count);
  const std::int64_t due = journey.landmark_count + std::distance(first_new, seen.end());
  if (landmark < 0 || landmark > due || !seen.insert(landmark).second) {
    return MustBe("landmark", landmark, absl::StrCat("in [0, ", due, "], once in a step"));
  }
  if (landmark >= journey.landmark_count) return absl::OkStatus();
  HOMING_ASSIGN_OR_RETURN(const Side side, SideOf(journey, landmark));
  if (side != recorded.side) {
    return MustBe(absl::StrCat("side of landmark ", landmark), Word(recorded.side),
                  absl::StrCat(Word(side), ", where it was met"));
  }
  return absl::OkStatus();
}

absl::Status StepAppends::CheckStep(JourneyColumns& journey, const JourneyStep& step,
                                    std::int64_t sequence) {
  const std::int64_t last = std::min(sequence, kMostSteps - 1);
  if (step.step < journey.step_count || step.step > last) {
    return MustBe("step", step.step, absl::StrCat("in [", journey.step_count, ", ", last, "]"));
  }
  const std::int64_t least = journey.last_sequence + 1 + step.step - journey.step_count;
  if (step.sequence != kNextSequence && step.sequence < least) {
    return absl::InvalidArgumentError(absl::StrCat("sequence of step ", step.step, " is ",
                                                   step.sequence, ": must be at least ", least));
  }
  HOMING_RETURN_IF_ERROR(CheckOrder(step));
  std::set<std::int32_t> seen;
  for (const RecordedFingerprint& recorded : step.fingerprints) {
    HOMING_RETURN_IF_ERROR(CheckValues(recorded));
    HOMING_RETURN_IF_ERROR(CheckLandmark(journey, recorded, seen));
  }
  return absl::OkStatus();
}

void StepAppends::AddStep(JourneyColumns& journey, const JourneyAppend& append) {
  const JourneyStep& step = *append.step;
  InsertStep(*connection_, journey.id, step);
  if (!step.fingerprints.empty()) journey.sides.clear();
  for (const RecordedFingerprint& recorded : step.fingerprints) {
    const std::int32_t landmark = recorded.fingerprint.landmark;
    journey.sides.emplace(landmark, recorded.side);
    if (landmark == journey.landmark_count) ++journey.landmark_count;
  }
  const bool is_first = journey.last_sequence < 0;
  const std::int64_t following =
      (is_first ? 1 : journey.last_sequence + 1) + step.step - journey.step_count;
  journey.last_sequence = step.sequence == kNextSequence ? following : step.sequence;
  journey.step_count = step.step + 1;
  journey.new_fingerprints += static_cast<std::int64_t>(step.fingerprints.size());
  // An observation without a step does not change the times, so that frames and the flow between
  // them agree.
  if (append.capture_time_ns != 0) {
    journey.last_time_ns = append.capture_time_ns;
    if (journey.first_time_ns == 0) journey.first_time_ns = append.capture_time_ns;
  }
}

absl::Status StepAppends::Append(const JourneyAppend& append) {
  HOMING_ASSIGN_OR_RETURN(JourneyColumns* const journey, Find(append.journey));
  HOMING_RETURN_IF_ERROR(CheckContinues(*journey, append));
  if (append.step) {
    HOMING_RETURN_IF_ERROR(CheckStep(*journey, *append.step, append.sequence));
    AddStep(*journey, append);
  }
  if (append.input != InputKind::kUnknown) journey->input = append.input;
  if (append.settings) journey->new_settings = append.settings;
  journey->next_sequence = append.sequence + 1;
  journey->resend_from = append.resend_from;
  if (!journey->is_changed) changed_.push_back(journey);
  journey->is_changed = true;
  return absl::OkStatus();
}

void StepAppends::Write() {
  for (JourneyColumns* const journey : changed_) WriteJourney(*journey);
  changed_.clear();
  if (journeys_.size() > kMostKept) Forget();
}

void StepAppends::Forget() {
  changed_.clear();
  journeys_.clear();
}

void StepAppends::WriteJourney(JourneyColumns& journey) {
  connection_
      ->Prepare(kUpdate, journey.id, journey.next_sequence, Word(journey.input),
                journey.first_time_ns, journey.last_time_ns, journey.step_count,
                journey.landmark_count, journey.new_fingerprints, journey.resend_from)
      .Run();
  if (journey.new_settings) {
    SetJourneySettings(*connection_, journey.id, *journey.new_settings);
  }
  journey.first_time_ns = 0;
  journey.last_time_ns = 0;
  journey.new_fingerprints = 0;
  journey.new_settings.reset();
  journey.is_changed = false;
}

}  // namespace homing::storage
