#include "storage/step_rows.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "absl/strings/str_cat.h"
#include "homing/landmark/profile_code.h"
#include "homing/status_macros.h"
#include "storage/fingerprint_id.h"
#include "storage/journey_rows.h"
#include "storage/row_words.h"
#include "storage/settings_json.h"

namespace homing::storage {
namespace {

constexpr char kFind[] =
    "SELECT journey_id, state, input, next_sequence, step_count, landmark_count FROM journeys"
    " WHERE name = ?";
constexpr char kFindSide[] = "SELECT side FROM landmarks WHERE journey_id = ? AND landmark = ?";
constexpr char kUpdate[] =
    "UPDATE journeys SET next_sequence = ?2, input = ?3,"
    " start_time_ns = CASE start_time_ns WHEN 0 THEN ?4 ELSE start_time_ns END,"
    " end_time_ns = CASE ?4 WHEN 0 THEN end_time_ns ELSE ?4 END,"
    " step_count = ?5, landmark_count = ?6, fingerprint_count = fingerprint_count + ?7"
    " WHERE journey_id = ?1";
constexpr char kSetSettings[] = "UPDATE journeys SET settings = ? WHERE journey_id = ?";
constexpr char kInsertFingerprint[] =
    "INSERT INTO fingerprints (fingerprint_id, landmark, x, y, count) VALUES (?,?,?,?,?)";
constexpr char kInsertLandmark[] =
    "INSERT INTO landmarks (journey_id, landmark, side, first_step, last_step, fingerprint_count,"
    " spread) VALUES (?,?,?,?,?,1,?)";
constexpr char kInsertProfile[] = "INSERT INTO profiles (profile_id, cells) VALUES (?,?)";
// The running mean: new = old + (s - old) / n, in double.
constexpr char kUpdateLandmark[] =
    "UPDATE landmarks SET last_step = ?3, fingerprint_count = fingerprint_count + 1,"
    " spread = spread + (?4 - spread) / (fingerprint_count + 1)"
    " WHERE journey_id = ?1 AND landmark = ?2";

// Two a camera (paper III).
constexpr int kMaxFingerprintsPerSide = 2;
constexpr double kMaxSpread = 1e9;

// The journey as far as appending needs it.
struct Target {
  std::int64_t id = 0;
  JourneyState state = JourneyState::kActive;
  InputKind input = InputKind::kUnknown;
  std::int64_t next_sequence = 0;
  std::int64_t step_count = 0;
  std::int32_t landmark_count = 0;
};

absl::StatusOr<Target> FindTarget(Connection& connection, const std::string& name) {
  Query query = connection.Prepare(kFind, name);
  if (!query.Next()) return JourneyNotFound(name);
  Target target;
  target.id = query.Integer(0);
  HOMING_ASSIGN_OR_RETURN(target.state, StateOfWord(query.Text(1)));
  HOMING_ASSIGN_OR_RETURN(target.input, InputOfWord(query.Text(2)));
  target.next_sequence = query.Integer(3);
  target.step_count = query.Integer(4);
  target.landmark_count = static_cast<std::int32_t>(query.Integer(5));
  return target;
}

absl::Status CheckContinues(const Target& target, const JourneyAppend& append) {
  if (target.state != JourneyState::kActive) {
    return absl::FailedPreconditionError(
        absl::StrCat("journey '", append.journey, "' is finished"));
  }
  if (append.sequence != target.next_sequence) {
    return absl::OutOfRangeError(absl::StrCat("sequence is ", append.sequence, ": ",
                                              target.next_sequence, " is due in journey '",
                                              append.journey, "'"));
  }
  if (target.input != InputKind::kUnknown && append.input != InputKind::kUnknown &&
      target.input != append.input) {
    return absl::FailedPreconditionError(absl::StrCat("input is ", Word(append.input),
                                                      ": journey '", append.journey,
                                                      "' is recorded from ", Word(target.input)));
  }
  return absl::OkStatus();
}

absl::Status CheckValues(const RecordedFingerprint& recorded) {
  const Fingerprint& fingerprint = recorded.fingerprint;
  if (!std::isfinite(fingerprint.x) || !std::isfinite(fingerprint.y)) {
    return absl::InvalidArgumentError(absl::StrCat("mean of landmark ", fingerprint.landmark,
                                                   " is (", fingerprint.x, ", ", fingerprint.y,
                                                   "): must be finite"));
  }
  if (!(recorded.spread >= 0 && recorded.spread <= kMaxSpread)) {
    return absl::InvalidArgumentError(absl::StrCat("spread of landmark ", fingerprint.landmark,
                                                   " is ", recorded.spread, ": must be 0 to ",
                                                   kMaxSpread));
  }
  if (fingerprint.count <= 0) {
    return absl::InvalidArgumentError(absl::StrCat("count of landmark ", fingerprint.landmark,
                                                   " is ", fingerprint.count,
                                                   ": must be at least 1"));
  }
  return absl::OkStatus();
}

// Left before right, at most two on a side.
absl::Status CheckOrder(const JourneyStep& step) {
  int left = 0;
  int right = 0;
  for (const RecordedFingerprint& recorded : step.fingerprints) {
    const bool is_left = recorded.side == Side::kLeft;
    if (is_left && right > 0) {
      return absl::InvalidArgumentError(
          absl::StrCat("step ", step.step, " has right before left: left must come first"));
    }
    if (++(is_left ? left : right) > kMaxFingerprintsPerSide) {
      return absl::InvalidArgumentError(absl::StrCat(
          "step ", step.step, " has over ", kMaxFingerprintsPerSide, " fingerprints on one side"));
    }
  }
  return absl::OkStatus();
}

// Landmarks must be known with that side, or come next in number; each once.
absl::Status CheckLandmark(Connection& connection, const Target& target,
                           const RecordedFingerprint& recorded, std::set<std::int32_t>& seen) {
  const std::int32_t landmark = recorded.fingerprint.landmark;
  const auto first_new = seen.lower_bound(target.landmark_count);
  const std::int64_t due = target.landmark_count + std::distance(first_new, seen.end());
  if (landmark < 0 || landmark > due || !seen.insert(landmark).second) {
    return absl::InvalidArgumentError(
        absl::StrCat("landmark is ", landmark, ": must be once in a step, and 0 to ", due));
  }
  if (landmark >= target.landmark_count) return absl::OkStatus();
  Query query = connection.Prepare(kFindSide, target.id, landmark);
  if (!query.Next()) {
    return absl::DataLossError(absl::StrCat("store: landmark ", landmark, " has no row"));
  }
  if (query.Text(0) != Word(recorded.side)) {
    return absl::InvalidArgumentError(absl::StrCat("side of landmark ", landmark, " is ",
                                                   Word(recorded.side), ": it was met on the ",
                                                   query.Text(0)));
  }
  return absl::OkStatus();
}

absl::Status CheckStep(Connection& connection, const Target& target, const JourneyStep& step,
                       std::int64_t sequence) {
  const std::int64_t last = std::min(sequence, kMostSteps - 1);
  if (step.step < target.step_count || step.step > last) {
    return absl::InvalidArgumentError(
        absl::StrCat("step is ", step.step, ": must be ", target.step_count, " to ", last));
  }
  HOMING_RETURN_IF_ERROR(CheckOrder(step));
  std::set<std::int32_t> seen;
  for (const RecordedFingerprint& recorded : step.fingerprints) {
    HOMING_RETURN_IF_ERROR(CheckValues(recorded));
    HOMING_RETURN_IF_ERROR(CheckLandmark(connection, target, recorded, seen));
  }
  return absl::OkStatus();
}

void WriteFingerprint(Connection& connection, Target& target, std::int64_t step, int index,
                      const RecordedFingerprint& recorded) {
  const Fingerprint& fingerprint = recorded.fingerprint;
  connection
      .Prepare(kInsertFingerprint, FingerprintId(target.id, step, index), fingerprint.landmark,
               double{fingerprint.x}, double{fingerprint.y}, fingerprint.count)
      .Run();
  if (fingerprint.landmark == target.landmark_count) {
    connection
        .Prepare(kInsertLandmark, target.id, fingerprint.landmark, Word(recorded.side), step, step,
                 recorded.spread)
        .Run();
    ++target.landmark_count;
  } else {
    connection.Prepare(kUpdateLandmark, target.id, fingerprint.landmark, step, recorded.spread)
        .Run();
  }
}

void WriteProfiles(Connection& connection, std::int64_t journey_id, const JourneyStep& step) {
  for (std::size_t side = 0; side < step.profiles.size(); ++side) {
    if (step.profiles[side]) {
      WriteProfile(connection, journey_id, step.step, Side{static_cast<int>(side)},
                   *step.profiles[side]);
    }
  }
}

}  // namespace

void WriteProfile(Connection& connection, std::int64_t journey_id, std::int64_t step, Side side,
                  const FlowProfile& profile) {
  const std::string cells = EncodeProfile(profile);
  if (!cells.empty()) {
    Query query =
        connection.Prepare(kInsertProfile, FingerprintId(journey_id, step, static_cast<int>(side)));
    query.BindBytes(2, cells);
    query.Run();
  }
}

absl::Status AppendStep(Connection& connection, const JourneyAppend& append) {
  HOMING_ASSIGN_OR_RETURN(Target target, FindTarget(connection, append.journey));
  HOMING_RETURN_IF_ERROR(CheckContinues(target, append));
  int index = 0;
  if (append.step) {
    HOMING_RETURN_IF_ERROR(CheckStep(connection, target, *append.step, append.sequence));
    for (const RecordedFingerprint& recorded : append.step->fingerprints) {
      WriteFingerprint(connection, target, append.step->step, index++, recorded);
    }
    WriteProfiles(connection, target.id, *append.step);
    target.step_count = append.step->step + 1;
  }
  // An observation without a step has no say: frames and the flow between them then agree.
  const std::int64_t step_time_ns = append.step ? append.capture_time_ns : 0;
  const InputKind input = append.input == InputKind::kUnknown ? target.input : append.input;
  connection
      .Prepare(kUpdate, target.id, append.sequence + 1, Word(input), step_time_ns,
               target.step_count, target.landmark_count, index)
      .Run();
  if (append.settings) {
    connection.Prepare(kSetSettings, ToJson(*append.settings), target.id).Run();
  }
  return absl::OkStatus();
}

}  // namespace homing::storage
