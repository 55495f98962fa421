#include "storage/journey_rows.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "storage/row_columns.h"
#include "storage/store_errors.h"

namespace homing::storage {
namespace {

constexpr char kInsertJourney[] =
    "INSERT INTO journeys (name, state, writer_id, readers, input, next_sequence, create_time_ns,"
    " start_time_ns, end_time_ns, step_count, landmark_count, fingerprint_count, resend_from)"
    " VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?) ON CONFLICT (name) DO NOTHING RETURNING journey_id";

constexpr char kFindJourney[] =
    "SELECT " HOMING_JOURNEY_COLUMNS ", journey_id" HOMING_JOURNEYS " WHERE name = ?";
constexpr char kListJourneys[] = "SELECT " HOMING_JOURNEY_COLUMNS HOMING_JOURNEYS
                                 " WHERE name > ? AND name >= ? AND name < ?"
                                 " ORDER BY name LIMIT ?";
constexpr char kInsertSettings[] =
    "INSERT INTO journey_settings (journey_id, settings) VALUES (?,?)";
constexpr char kSetSettings[] = "UPDATE journey_settings SET settings = ? WHERE journey_id = ?";
constexpr char kDelete[] = "DELETE FROM journeys WHERE name = ?";
constexpr char kSetState[] = "UPDATE journeys SET state = ? WHERE name = ?";
constexpr char kSetReaders[] = "UPDATE journeys SET readers = ? WHERE name = ?";
constexpr char kSetWriter[] = "UPDATE journeys SET writer_id = ? WHERE name = ?";

// Sorts after every name with this prefix: no UTF-8 text holds this byte.
constexpr char kAfterAll[] = "\xff";

absl::Status FoundIf(int rows_changed, const std::string& name) {
  return rows_changed > 0 ? absl::OkStatus() : JourneyNotFound(name);
}

}  // namespace

absl::StatusOr<std::int64_t> InsertJourney(Connection& connection, const JourneyRecord& record) {
  Query query = connection.Prepare(
      kInsertJourney, record.name, Word(record.state), record.writer_id, ToJson(record.readers),
      Word(record.input), record.next_sequence, record.create_time_ns, record.start_time_ns,
      record.end_time_ns, record.step_count, record.landmark_count, record.fingerprint_count,
      record.resend_from);
  if (!query.Next()) return JourneyExists(record.name);
  const std::int64_t id = query.Integer(0);
  connection.Prepare(kInsertSettings, id, ToJson(record.settings)).Run();
  return id;
}

absl::StatusOr<JourneyRow> FindJourney(Connection& connection, const std::string& name) {
  Query query = connection.Prepare(kFindJourney, name);
  if (!query.Next()) return JourneyNotFound(name);
  JourneyRow row;
  HOMING_ASSIGN_OR_RETURN(row.record, ReadRecord(query));
  row.id = query.Integer(14);
  return row;
}

absl::StatusOr<std::vector<JourneyRecord>> ListJourneyRows(Connection& connection,
                                                           const std::string& prefix,
                                                           const std::string& after, int limit) {
  std::vector<JourneyRecord> records;
  Query query = connection.Prepare(kListJourneys, after, prefix, absl::StrCat(prefix, kAfterAll),
                                   std::max(limit, 0));
  while (query.Next()) records.push_back(ReadListed(query));
  return records;
}

absl::Status DeleteJourneyRow(Connection& connection, const std::string& name) {
  return FoundIf(connection.Prepare(kDelete, name).Run(), name);
}

absl::Status SetJourneyState(Connection& connection, const std::string& name, JourneyState state) {
  return FoundIf(connection.Prepare(kSetState, Word(state), name).Run(), name);
}

void SetJourneySettings(Connection& connection, std::int64_t journey_id,
                        const JourneySettings& settings) {
  connection.Prepare(kSetSettings, ToJson(settings), journey_id).Run();
}

absl::Status SetJourneyWriter(Connection& connection, const std::string& name,
                              const std::string& writer_id) {
  return FoundIf(connection.Prepare(kSetWriter, writer_id, name).Run(), name);
}

absl::Status SetJourneyReaders(Connection& connection, const std::string& name,
                               const std::vector<std::string>& readers) {
  return FoundIf(connection.Prepare(kSetReaders, ToJson(readers), name).Run(), name);
}

}  // namespace homing::storage
