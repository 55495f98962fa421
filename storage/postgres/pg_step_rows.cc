#include "storage/postgres/pg_step_rows.h"

#include <bit>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "homing/landmark/profile_code.h"
#include "storage/row_columns.h"

namespace homing::storage::postgres {
namespace {

constexpr char kSelectSteps[] =
    "SELECT step, sequence, fingerprints, left_profile, right_profile FROM steps"
    " WHERE journey_id = $1 AND step >= $2 ORDER BY step";
constexpr char kSelectLast[] =
    "SELECT step, sequence FROM steps"
    " WHERE journey_id = $1 AND step < $2 AND sequence IS NOT NULL ORDER BY step DESC LIMIT 1";
constexpr char kSelectBack[] =
    "SELECT step, fingerprints FROM steps WHERE journey_id = $1 AND step < $2"
    " ORDER BY step DESC LIMIT 64";
constexpr char kInsertSteps[] =
    "INSERT INTO steps SELECT journey_id, step, nullif(sequence, -1), fingerprints, left_profile,"
    " right_profile FROM unnest($1::bigint[], $2::bigint[], $3::bigint[], $4::bytea[], $5::bytea[],"
    " $6::bytea[]) AS s(journey_id, step, sequence, fingerprints, left_profile, right_profile)";

constexpr std::size_t kFingerprintBytes = 25;
// Rows of one INSERT.
constexpr std::size_t kRowsAtOnce = 1000;

std::int32_t Int32At(const char* bytes) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(ReadBigEndian(bytes, 4)));
}

float FloatAt(const char* bytes) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(ReadBigEndian(bytes, 4)));
}

std::optional<std::string> ProfileBytes(const std::optional<FlowProfile>& profile) {
  if (!profile) return std::nullopt;
  std::string bytes = EncodeProfile(*profile);
  if (bytes.empty()) return std::nullopt;
  return bytes;
}

absl::StatusOr<JourneyStep> StepOfRow(const PgRows& rows, int row) {
  JourneyStep step;
  step.step = rows.Integer(row, 0);
  if (!rows.IsNull(row, 1)) step.sequence = StoredSequence(rows.Integer(row, 1));
  HOMING_ASSIGN_OR_RETURN(step.fingerprints, DecodeFingerprints(rows.Text(row, 2)));
  for (int side = 0; side < 2; ++side) {
    if (rows.IsNull(row, 3 + side)) continue;
    HOMING_ASSIGN_OR_RETURN(step.profiles[static_cast<std::size_t>(side)],
                            DecodeProfile(rows.Text(row, 3 + side)));
  }
  return step;
}

}  // namespace

std::string EncodeFingerprints(const std::vector<RecordedFingerprint>& fingerprints) {
  std::string bytes;
  bytes.reserve(fingerprints.size() * kFingerprintBytes);
  for (const RecordedFingerprint& recorded : fingerprints) {
    const Fingerprint& fingerprint = recorded.fingerprint;
    AppendBigEndian(recorded.side == Side::kLeft ? 0 : 1, 1, &bytes);
    AppendBigEndian(static_cast<std::uint32_t>(fingerprint.landmark), 4, &bytes);
    AppendBigEndian(std::bit_cast<std::uint32_t>(fingerprint.x), 4, &bytes);
    AppendBigEndian(std::bit_cast<std::uint32_t>(fingerprint.y), 4, &bytes);
    AppendBigEndian(static_cast<std::uint32_t>(fingerprint.count), 4, &bytes);
    AppendBigEndian(std::bit_cast<std::uint64_t>(recorded.spread), 8, &bytes);
  }
  return bytes;
}

absl::StatusOr<std::vector<RecordedFingerprint>> DecodeFingerprints(const std::string& bytes) {
  if (bytes.size() % kFingerprintBytes != 0) {
    return absl::DataLossError(absl::StrCat("store: fingerprints: ", bytes.size(),
                                            " bytes must be a multiple of ", kFingerprintBytes));
  }
  std::vector<RecordedFingerprint> fingerprints;
  for (std::size_t at = 0; at < bytes.size(); at += kFingerprintBytes) {
    const char* const begin = bytes.data() + at;
    RecordedFingerprint& recorded = fingerprints.emplace_back();
    recorded.side = begin[0] == 0 ? Side::kLeft : Side::kRight;
    recorded.fingerprint = {FloatAt(begin + 5), FloatAt(begin + 9), Int32At(begin + 13),
                            Int32At(begin + 1)};
    recorded.spread = std::bit_cast<double>(ReadBigEndian(begin + 17, 8));
  }
  return fingerprints;
}

void StepColumns::Add(std::int64_t journey_id, const JourneyStep& step) {
  journey_ids.push_back(journey_id);
  steps.push_back(step.step);
  sequences.push_back(step.sequence);
  fingerprints.emplace_back(EncodeFingerprints(step.fingerprints));
  left_profiles.push_back(ProfileBytes(step.profiles[0]));
  right_profiles.push_back(ProfileBytes(step.profiles[1]));
}

void StepColumns::AddTo(PgArguments* arguments) const {
  static_assert(kNextSequence == -1);
  arguments->Integers(journey_ids).Integers(steps).Integers(sequences);
  arguments->Blobs(fingerprints).Blobs(left_profiles).Blobs(right_profiles);
}

absl::StatusOr<PgRows> SelectSteps(PgConnection& connection, std::int64_t journey_id,
                                   std::int64_t first, Deadline deadline) {
  return connection.Run(kSelectSteps, PgArguments().Integer(journey_id).Integer(first), deadline);
}

StepReader ReaderOf(const PgRows& rows) {
  return [&rows, row = 0]() mutable -> absl::StatusOr<std::optional<JourneyStep>> {
    if (row == rows.size()) return std::nullopt;
    return StepOfRow(rows, row++);
  };
}

absl::StatusOr<std::int64_t> FindLastSequence(PgConnection& connection, std::int64_t journey_id,
                                              std::int64_t step_count, Deadline deadline) {
  HOMING_ASSIGN_OR_RETURN(
      const PgRows rows,
      connection.Run(kSelectLast, PgArguments().Integer(journey_id).Integer(step_count), deadline));
  if (rows.size() == 0) return step_count == 0 ? -1 : step_count;
  return LastSequence(rows.Integer(0, 0), rows.Integer(0, 1), step_count);
}

absl::StatusOr<std::optional<Side>> FindSide(PgConnection& connection, std::int64_t journey_id,
                                             std::int32_t landmark, Deadline deadline) {
  std::int64_t before = std::numeric_limits<std::int64_t>::max();
  while (true) {
    HOMING_ASSIGN_OR_RETURN(
        const PgRows rows,
        connection.Run(kSelectBack, PgArguments().Integer(journey_id).Integer(before), deadline));
    if (rows.size() == 0) return std::nullopt;
    for (int row = 0; row < rows.size(); ++row) {
      HOMING_ASSIGN_OR_RETURN(const auto fingerprints, DecodeFingerprints(rows.Text(row, 1)));
      for (const RecordedFingerprint& recorded : fingerprints) {
        if (recorded.fingerprint.landmark == landmark) return recorded.side;
      }
    }
    before = rows.Integer(rows.size() - 1, 0);
  }
}

absl::Status InsertMap(PgConnection& connection, std::int64_t journey_id, const JourneyMap& map,
                       Deadline deadline) {
  StepColumns columns;
  for (std::int64_t number = 0; number < map.step_count(); ++number) {
    columns.Add(journey_id, StepOfMap(map, number));
    if (columns.steps.size() < kRowsAtOnce && number + 1 < map.step_count()) continue;
    PgArguments arguments;
    columns.AddTo(&arguments);
    HOMING_RETURN_IF_ERROR(connection.Run(kInsertSteps, arguments, deadline).status());
    columns.Clear();
  }
  return absl::OkStatus();
}

}  // namespace homing::storage::postgres
