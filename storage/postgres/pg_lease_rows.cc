// The lease of a journey's writer across servers.
#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "storage/postgres/pg_journey_rows.h"
#include "storage/store_errors.h"

namespace homing::storage::postgres {
namespace {

// Another server that is alive has written the journey in the last 15 s for a writer of another
// program. All times are the database's; those in its future come from a primary whose clock was
// ahead, and hold nothing.
#define HOMING_PG_LEASE_HELD                                                     \
  "(server_id <> $4 AND split_part(writer_id, '#', 1) <> split_part($3, '#', 1)" \
  " AND written_at BETWEEN now() - interval '15 s' AND now() + interval '15 s'"  \
  " AND EXISTS (SELECT FROM servers s WHERE s.server_id = j.server_id"           \
  " AND s.beat_at BETWEEN now() - interval '15 s' AND now() + interval '15 s'))"

constexpr char kCheckLease[] =
    "SELECT CASE WHEN " HOMING_PG_LEASE_HELD
    " THEN ceil(1000 * extract(epoch FROM written_at + interval '15 s' - now()))::bigint"
    " ELSE 0::bigint END, state FROM journeys j WHERE journey_id = $1 AND name = $2";
constexpr char kAcquire[] =
    "UPDATE journeys j SET writer_id = $3, server_id = $4, epoch = nextval('journey_epochs'),"
    " written_at = now() WHERE journey_id = $1 AND name = $2 AND state = 'ACTIVE' AND "
    "NOT " HOMING_PG_LEASE_HELD " RETURNING epoch";
constexpr char kBeat[] =
    "WITH dead AS (DELETE FROM servers"
    " WHERE beat_at < now() - interval '1 day' AND server_id <> $1)"
    " INSERT INTO servers (server_id, beat_at) VALUES ($1, now())"
    " ON CONFLICT (server_id) DO UPDATE SET beat_at = excluded.beat_at";
constexpr char kRemove[] = "DELETE FROM servers WHERE server_id = $1";

PgArguments LeaseArguments(const std::string& name, const std::string& writer_id,
                           std::int64_t server_id) {
  PgArguments arguments;
  arguments.Integer(JourneyId(name)).Text(name).Text(writer_id).Integer(server_id);
  return arguments;
}

}  // namespace

absl::Status CheckLeaseRow(PgConnection& connection, const std::string& name,
                           const std::string& writer_id, std::int64_t server_id,
                           Deadline deadline) {
  HOMING_ASSIGN_OR_RETURN(
      const PgRows rows,
      connection.Run(kCheckLease, LeaseArguments(name, writer_id, server_id), deadline));
  if (rows.size() == 0) return JourneyNotFound(name);
  if (rows.Integer(0, 0) == 0) return absl::OkStatus();
  return absl::AbortedError(
      absl::StrCat("journey '", name,
                   "': another writer records it through another server, and its lease of"
                   " 15 s ends in ",
                   rows.Integer(0, 0), " ms"));
}

absl::StatusOr<std::int64_t> AcquireJourneyRow(PgConnection& connection, const std::string& name,
                                               const std::string& writer_id, std::int64_t server_id,
                                               Deadline deadline) {
  HOMING_ASSIGN_OR_RETURN(
      const PgRows rows,
      connection.Run(kAcquire, LeaseArguments(name, writer_id, server_id), deadline));
  if (rows.size() == 1) return rows.Integer(0, 0);
  HOMING_RETURN_IF_ERROR(CheckLeaseRow(connection, name, writer_id, server_id, deadline));
  return JourneyIsFinished(name);
}

absl::Status Beat(PgConnection& connection, std::int64_t server_id, Deadline deadline) {
  return connection.Run(kBeat, PgArguments().Integer(server_id), deadline).status();
}

absl::Status RemoveServer(PgConnection& connection, std::int64_t server_id, Deadline deadline) {
  return connection.Run(kRemove, PgArguments().Integer(server_id), deadline).status();
}

}  // namespace homing::storage::postgres
