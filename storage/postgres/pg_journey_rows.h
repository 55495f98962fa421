// Rows of `journeys`, `journey_settings` and `servers` in PostgreSQL.
#ifndef STORAGE_POSTGRES_PG_JOURNEY_ROWS_H_
#define STORAGE_POSTGRES_PG_JOURNEY_ROWS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "storage/growing_journey.h"
#include "storage/journey_store.h"
#include "storage/postgres/pg_connection.h"

namespace homing::storage::postgres {

// 63 bits of a hash of the name: servers make the same key without asking, and a sharded
// PostgreSQL can distribute by it.
std::int64_t JourneyId(const std::string& name);

// Writes the counts too. ALREADY_EXISTS; also for another name of the same hash.
absl::Status InsertJourney(PgConnection& connection, const JourneyRecord& record,
                           Deadline deadline);
// NOT_FOUND, DATA_LOSS.
absl::StatusOr<JourneyRecord> FindJourney(PgConnection& connection, const std::string& name,
                                          Deadline deadline);
// The part for appending, with no landmark seen. NOT_FOUND.
absl::StatusOr<GrowingJourney> FindGrowing(PgConnection& connection, const std::string& name,
                                           Deadline deadline);
absl::StatusOr<std::vector<JourneyRecord>> ListJourneyRows(PgConnection& connection,
                                                           const std::string& prefix,
                                                           const std::string& after, int limit,
                                                           Deadline deadline);
absl::StatusOr<std::vector<JourneyMark>> LoadJourneyMarks(PgConnection& connection,
                                                          const std::vector<std::string>& names,
                                                          Deadline deadline);
// NOT_FOUND. REQUIRES: a transaction.
absl::Status DeleteJourneyRow(PgConnection& connection, const std::string& name, Deadline deadline);
// NOT_FOUND.
absl::Status FinishJourneyRow(PgConnection& connection, const std::string& name, Deadline deadline);
absl::Status SetJourneyReaders(PgConnection& connection, const std::string& name,
                               const std::vector<std::string>& readers, Deadline deadline);

// -- The lease of a journey's writer, by the database's clock.

// As JourneyStore::CheckLease.
absl::Status CheckLeaseRow(PgConnection& connection, const std::string& name,
                           const std::string& writer_id, std::int64_t server_id, Deadline deadline);
// As JourneyStore::AcquireJourney; returns the epoch.
absl::StatusOr<std::int64_t> AcquireJourneyRow(PgConnection& connection, const std::string& name,
                                               const std::string& writer_id, std::int64_t server_id,
                                               Deadline deadline);
// Shows that the server is alive; removes servers that have been dead for a day.
absl::Status Beat(PgConnection& connection, std::int64_t server_id, Deadline deadline);
// The server has stopped: its journeys are free.
absl::Status RemoveServer(PgConnection& connection, std::int64_t server_id, Deadline deadline);

}  // namespace homing::storage::postgres

#endif  // STORAGE_POSTGRES_PG_JOURNEY_ROWS_H_
