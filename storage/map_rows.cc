#include "storage/map_rows.h"

#include <vector>

#include "absl/strings/str_cat.h"
#include "homing/landmark/profile_code.h"
#include "homing/status_macros.h"
#include "storage/fingerprint_id.h"
#include "storage/row_words.h"
#include "storage/step_rows.h"

namespace homing::storage {
namespace {

constexpr char kSelectLandmarks[] =
    "SELECT landmark, side, first_step, last_step, fingerprint_count, spread FROM landmarks"
    " WHERE journey_id = ? ORDER BY landmark";
constexpr char kSelectFingerprints[] =
    "SELECT fingerprint_id, landmark, x, y, count FROM fingerprints"
    " WHERE fingerprint_id >= ? AND fingerprint_id < ? ORDER BY fingerprint_id";
constexpr char kSelectTail[] =
    "SELECT f.fingerprint_id, f.landmark, f.x, f.y, f.count, coalesce(l.side, '')"
    " FROM fingerprints f LEFT JOIN landmarks l ON l.journey_id = ? AND l.landmark = f.landmark"
    " WHERE f.fingerprint_id >= ? AND f.fingerprint_id < ? ORDER BY f.fingerprint_id";
constexpr char kSelectProfiles[] =
    "SELECT profile_id, cells FROM profiles WHERE profile_id >= ? AND profile_id < ?"
    " ORDER BY profile_id";
constexpr char kInsertFingerprint[] =
    "INSERT INTO fingerprints (fingerprint_id, landmark, x, y, count) VALUES (?,?,?,?,?)";

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

// Of a row of kSelectFingerprints or kSelectTail.
absl::StatusOr<std::int64_t> StepOfRow(Query& query, const JourneyRow& journey) {
  const std::int64_t step = StepOfFingerprint(query.Integer(0));
  if (step >= journey.record.step_count) {
    return Contradiction(
        journey, absl::StrCat("a fingerprint at step ", step, " of ", journey.record.step_count));
  }
  return step;
}

Fingerprint FingerprintOfRow(Query& query) {
  return {static_cast<float>(query.Real(2)), static_cast<float>(query.Real(3)),
          static_cast<std::int32_t>(query.Integer(4)), static_cast<std::int32_t>(query.Integer(1))};
}

absl::StatusOr<std::vector<Landmark>> ReadLandmarks(Connection& connection,
                                                    const JourneyRow& journey) {
  std::vector<Landmark> landmarks;
  Query query = connection.Prepare(kSelectLandmarks, journey.id);
  while (query.Next()) {
    if (query.Integer(0) != static_cast<std::int64_t>(landmarks.size())) {
      return Contradiction(journey, "landmarks are not numbered from 0 without gaps");
    }
    Landmark landmark;
    HOMING_ASSIGN_OR_RETURN(landmark.side, SideOfWord(query.Text(1)));
    landmark.first_step = query.Integer(2);
    landmark.last_step = query.Integer(3);
    landmark.fingerprint_count = static_cast<std::int32_t>(query.Integer(4));
    landmark.spread = query.Real(5);
    landmarks.push_back(landmark);
  }
  return landmarks;
}

// One row of kSelectFingerprints. The mean spread of a landmark stands for that of each of its
// steps: a running mean of equal values is that value, to the bit.
absl::StatusOr<RecordedFingerprint> ReadFingerprint(Query& query, const JourneyRow& journey,
                                                    const std::vector<Landmark>& landmarks) {
  const std::int64_t landmark = query.Integer(1);
  if (landmark < 0 || landmark >= static_cast<std::int64_t>(landmarks.size())) {
    return Contradiction(journey, absl::StrCat("landmark ", landmark, " has no row"));
  }
  const Landmark& known = landmarks[static_cast<std::size_t>(landmark)];
  RecordedFingerprint recorded;
  recorded.side = known.side;
  recorded.spread = known.spread;
  recorded.fingerprint = FingerprintOfRow(query);
  return recorded;
}

absl::Status AppendTo(JourneyMap& map, JourneyStep& step, const JourneyRow& journey) {
  if (step.fingerprints.empty()) return absl::OkStatus();
  const absl::Status status = map.Append(step);
  step.fingerprints.clear();
  return status.ok() ? status : Contradiction(journey, std::string(status.message()));
}

absl::Status ReadSteps(Connection& connection, const JourneyRow& journey,
                       const std::vector<Landmark>& landmarks, JourneyMap& map) {
  JourneyStep step;
  Query query = connection.Prepare(kSelectFingerprints, FingerprintId(journey.id, 0, 0),
                                   FingerprintId(journey.id + 1, 0, 0));
  while (query.Next()) {
    HOMING_ASSIGN_OR_RETURN(const std::int64_t number, StepOfRow(query, journey));
    if (number != step.step) HOMING_RETURN_IF_ERROR(AppendTo(map, step, journey));
    step.step = number;
    HOMING_ASSIGN_OR_RETURN(RecordedFingerprint recorded,
                            ReadFingerprint(query, journey, landmarks));
    step.fingerprints.push_back(recorded);
  }
  return AppendTo(map, step, journey);
}

absl::Status ReadProfiles(Connection& connection, const JourneyRow& journey, JourneyMap& map) {
  Query query = connection.Prepare(kSelectProfiles, FingerprintId(journey.id, 0, 0),
                                   FingerprintId(journey.id + 1, 0, 0));
  while (query.Next()) {
    const std::int64_t step = StepOfFingerprint(query.Integer(0));
    const std::int64_t side = IndexOfFingerprint(query.Integer(0));
    const auto profile = DecodeProfile(query.Bytes(1));
    if (step >= map.step_count() || side > 1 || !profile.ok()) {
      return Contradiction(journey, absl::StrCat("the flow profile of step ", step));
    }
    map.set_profile(step, Side{static_cast<int>(side)}, *profile);
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<JourneyMap> ReadMap(Connection& connection, const JourneyRow& journey) {
  const JourneyRecord& record = journey.record;
  HOMING_RETURN_IF_ERROR(CheckStepCount(journey));
  HOMING_ASSIGN_OR_RETURN(std::vector<Landmark> landmarks, ReadLandmarks(connection, journey));
  JourneyMap map(record.settings);
  HOMING_RETURN_IF_ERROR(ReadSteps(connection, journey, landmarks, map));
  map.ExtendTo(record.step_count);
  HOMING_RETURN_IF_ERROR(ReadProfiles(connection, journey, map));
  if (map.landmarks() != landmarks ||
      static_cast<std::size_t>(record.landmark_count) != landmarks.size()) {
    return Contradiction(journey, "its landmarks and fingerprints disagree");
  }
  if (static_cast<std::size_t>(record.fingerprint_count) != map.all_fingerprints().size()) {
    return Contradiction(journey, absl::StrCat("it has ", map.all_fingerprints().size(),
                                               " fingerprints, not ", record.fingerprint_count));
  }
  return map;
}

absl::StatusOr<JourneyTail> ReadTail(Connection& connection, const JourneyRow& journey) {
  const JourneyRecord& record = journey.record;
  HOMING_RETURN_IF_ERROR(CheckStepCount(journey));
  JourneyTail tail{record.step_count, record.landmark_count, {}};
  Query query = connection.Prepare(
      kSelectTail, journey.id,
      FingerprintId(journey.id, FirstTailStep(record.settings, record.step_count), 0),
      FingerprintId(journey.id + 1, 0, 0));
  while (query.Next()) {
    HOMING_ASSIGN_OR_RETURN(const std::int64_t number, StepOfRow(query, journey));
    if (tail.steps.empty() || tail.steps.back().step != number) {
      tail.steps.emplace_back().step = number;
    }
    RecordedFingerprint recorded;
    HOMING_ASSIGN_OR_RETURN(recorded.side, SideOfWord(query.Text(5)));
    recorded.fingerprint = FingerprintOfRow(query);
    tail.steps.back().fingerprints.push_back(recorded);
  }
  return tail;
}

void InsertFingerprint(Connection& connection, std::int64_t id, const Fingerprint& fingerprint) {
  connection
      .Prepare(kInsertFingerprint, id, fingerprint.landmark, double{fingerprint.x},
               double{fingerprint.y}, fingerprint.count)
      .Run();
}

void WriteMap(Connection& connection, std::int64_t journey_id, const JourneyMap& map) {
  int number = 0;
  for (const Landmark& landmark : map.landmarks()) {
    InsertLandmark(connection, journey_id, number++, landmark);
  }
  for (std::int64_t step = 0; step < map.step_count(); ++step) {
    int index = 0;
    for (const Fingerprint& fingerprint : map.fingerprints(step)) {
      InsertFingerprint(connection, FingerprintId(journey_id, step, index++), fingerprint);
    }
  }
  for (const Side side : {Side::kLeft, Side::kRight}) {
    std::int64_t step = 0;
    for (const FlowProfile& profile : map.profiles(side)) {
      WriteProfile(connection, journey_id, step++, side, profile);
    }
  }
}

}  // namespace homing::storage
