#include "storage/postgres/pg_journey_rows.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "storage/postgres/pg_step_rows.h"
#include "storage/row_columns.h"
#include "storage/store_errors.h"

namespace homing::storage::postgres {
namespace {

constexpr char kInsertJourney[] =
    "WITH created AS (INSERT INTO journeys (journey_id, name, state, writer_id, readers, input,"
    " next_sequence, resend_from, create_time_ns, start_time_ns, end_time_ns, step_count,"
    " landmark_count, fingerprint_count)"
    " VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10, $11, $12, $13, $14)"
    " ON CONFLICT (journey_id) DO NOTHING RETURNING journey_id)"
    " INSERT INTO journey_settings (journey_id, settings) SELECT journey_id, $15 FROM created";

constexpr char kFindJourney[] =
    "SELECT " HOMING_JOURNEY_COLUMNS HOMING_JOURNEYS " WHERE journey_id = $1 AND name = $2";
// The last code point sorts after every name with the prefix.
constexpr char kListJourneys[] =
    "SELECT " HOMING_JOURNEY_COLUMNS HOMING_JOURNEYS
    " WHERE name > $1 AND name >= $2 AND name < $2 || chr(1114111) ORDER BY name LIMIT $3";
constexpr char kFindGrowing[] =
    "SELECT journey_id, epoch, state, input, next_sequence, resend_from, step_count,"
    " landmark_count FROM journeys WHERE journey_id = $1 AND name = $2";
constexpr char kFindMarks[] =
    "SELECT name, create_time_ns, state, next_sequence, epoch, revision FROM journeys"
    " WHERE journey_id = ANY($1)";
constexpr char kDelete[] = "DELETE FROM journeys WHERE journey_id = $1 AND name = $2";
constexpr char kDeleteSteps[] = "DELETE FROM steps WHERE journey_id = $1";
constexpr char kFinish[] =
    "UPDATE journeys SET state = 'FINISHED' WHERE journey_id = $1 AND name = $2";
constexpr char kSetReaders[] =
    "UPDATE journeys SET readers = $3, revision = revision + 1"
    " WHERE journey_id = $1 AND name = $2";

PgArguments KeyOf(const std::string& name) {
  PgArguments arguments;
  arguments.Integer(JourneyId(name)).Text(name);
  return arguments;
}

absl::Status ChangedOrNotFound(const absl::StatusOr<PgRows>& rows, const std::string& name) {
  HOMING_RETURN_IF_ERROR(rows.status());
  return rows->changed() > 0 ? absl::OkStatus() : JourneyNotFound(name);
}

}  // namespace

// FNV-1a of 64 bits, whose low bits are then mixed into the high ones.
std::int64_t JourneyId(const std::string& name) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : name) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  }
  hash ^= hash >> 32U;
  return static_cast<std::int64_t>(hash >> 1U);
}

absl::Status InsertJourney(PgConnection& connection, const JourneyRecord& record,
                           Deadline deadline) {
  PgArguments arguments = KeyOf(record.name);
  arguments.Text(Word(record.state)).Text(record.writer_id).Text(ToJson(record.readers));
  arguments.Text(Word(record.input)).Integer(record.next_sequence).Integer(record.resend_from);
  arguments.Integer(record.create_time_ns).Integer(record.start_time_ns);
  arguments.Integer(record.end_time_ns).Integer(record.step_count);
  arguments.Integer(record.landmark_count).Integer(record.fingerprint_count);
  arguments.Text(ToJson(record.settings));
  HOMING_ASSIGN_OR_RETURN(const PgRows inserted,
                          connection.Run(kInsertJourney, arguments, deadline));
  if (inserted.changed() > 0) return absl::OkStatus();
  if (FindJourney(connection, record.name, deadline).ok()) return JourneyExists(record.name);
  return absl::AlreadyExistsError(absl::StrCat(
      "journey '", record.name, "' has the same hash as another one: choose another name"));
}

absl::StatusOr<JourneyRecord> FindJourney(PgConnection& connection, const std::string& name,
                                          Deadline deadline) {
  HOMING_ASSIGN_OR_RETURN(const PgRows rows, connection.Run(kFindJourney, KeyOf(name), deadline));
  if (rows.size() == 0) return JourneyNotFound(name);
  const PgRow row{rows, 0};
  return ReadRecord(row);
}

absl::StatusOr<GrowingJourney> FindGrowing(PgConnection& connection, const std::string& name,
                                           Deadline deadline) {
  HOMING_ASSIGN_OR_RETURN(const PgRows rows, connection.Run(kFindGrowing, KeyOf(name), deadline));
  if (rows.size() == 0) return JourneyNotFound(name);
  GrowingJourney journey;
  journey.id = rows.Integer(0, 0);
  journey.epoch = rows.Integer(0, 1);
  HOMING_ASSIGN_OR_RETURN(journey.state, StateOfWord(rows.Text(0, 2)));
  HOMING_ASSIGN_OR_RETURN(journey.input, InputOfWord(rows.Text(0, 3)));
  journey.next_sequence = rows.Integer(0, 4);
  journey.resend_from = rows.Integer(0, 5);
  journey.step_count = rows.Integer(0, 6);
  journey.landmark_count = static_cast<std::int32_t>(rows.Integer(0, 7));
  HOMING_ASSIGN_OR_RETURN(journey.last_sequence,
                          FindLastSequence(connection, journey.id, journey.step_count, deadline));
  return journey;
}

absl::StatusOr<std::vector<JourneyRecord>> ListJourneyRows(PgConnection& connection,
                                                           const std::string& prefix,
                                                           const std::string& after, int limit,
                                                           Deadline deadline) {
  PgArguments arguments;
  arguments.Text(after).Text(prefix).Integer(std::max(limit, 0));
  HOMING_ASSIGN_OR_RETURN(const PgRows rows, connection.Run(kListJourneys, arguments, deadline));
  std::vector<JourneyRecord> records;
  for (int row = 0; row < rows.size(); ++row) {
    const PgRow at{rows, row};
    records.push_back(ReadListed(at));
  }
  return records;
}

absl::StatusOr<std::vector<JourneyMark>> LoadJourneyMarks(PgConnection& connection,
                                                          const std::vector<std::string>& names,
                                                          Deadline deadline) {
  std::vector<std::int64_t> ids;
  ids.reserve(names.size());
  for (const std::string& name : names) ids.push_back(JourneyId(name));
  HOMING_ASSIGN_OR_RETURN(const PgRows rows,
                          connection.Run(kFindMarks, PgArguments().Integers(ids), deadline));
  std::vector<JourneyMark> marks;
  for (int row = 0; row < rows.size(); ++row) {
    JourneyMark& mark = marks.emplace_back();
    mark.name = rows.Text(row, 0);
    mark.create_time_ns = rows.Integer(row, 1);
    HOMING_ASSIGN_OR_RETURN(mark.state, StateOfWord(rows.Text(row, 2)));
    mark.next_sequence = rows.Integer(row, 3);
    mark.epoch = rows.Integer(row, 4);
    mark.revision = rows.Integer(row, 5);
  }
  return marks;
}

absl::Status DeleteJourneyRow(PgConnection& connection, const std::string& name,
                              Deadline deadline) {
  // The journey first: its row lock keeps appends away until the end of the transaction, and the
  // second statement sees the steps of those that it waited for.
  HOMING_RETURN_IF_ERROR(ChangedOrNotFound(connection.Run(kDelete, KeyOf(name), deadline), name));
  return connection.Run(kDeleteSteps, PgArguments().Integer(JourneyId(name)), deadline).status();
}

absl::Status FinishJourneyRow(PgConnection& connection, const std::string& name,
                              Deadline deadline) {
  return ChangedOrNotFound(connection.Run(kFinish, KeyOf(name), deadline), name);
}

absl::Status SetJourneyReaders(PgConnection& connection, const std::string& name,
                               const std::vector<std::string>& readers, Deadline deadline) {
  PgArguments arguments = KeyOf(name);
  arguments.Text(ToJson(readers));
  return ChangedOrNotFound(connection.Run(kSetReaders, arguments, deadline), name);
}

}  // namespace homing::storage::postgres
