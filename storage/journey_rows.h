// Rows of `journeys` and `journey_settings`. All functions run in the body of a transaction and
// throw SQLite::Exception, which ends the transaction.
#ifndef STORAGE_JOURNEY_ROWS_H_
#define STORAGE_JOURNEY_ROWS_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "storage/connection.h"
#include "storage/journey_store.h"

namespace homing::storage {

struct JourneyRow {
  // Internal to the store.
  std::int64_t id = 0;
  JourneyRecord record;
};

// Begins the name of a journey that is being deleted, and that no reader of the store sees.
inline constexpr char kHiddenPrefix[] = "deleted/";

// Writes the counts too. ALREADY_EXISTS. Returns the id.
absl::StatusOr<std::int64_t> InsertJourney(Connection& connection, const JourneyRecord& record);
// NOT_FOUND, DATA_LOSS.
absl::StatusOr<JourneyRow> FindJourney(Connection& connection, const std::string& name);
absl::StatusOr<std::vector<JourneyRecord>> ListJourneyRows(Connection& connection,
                                                           const std::string& prefix,
                                                           const std::string& after, int limit);
// NOT_FOUND.
absl::Status DeleteJourneyRow(Connection& connection, const std::string& name);
absl::Status SetJourneyState(Connection& connection, const std::string& name, JourneyState state);
void SetJourneySettings(Connection& connection, std::int64_t journey_id,
                        const JourneySettings& settings);
// NOT_FOUND.
absl::Status SetJourneyReaders(Connection& connection, const std::string& name,
                               const std::vector<std::string>& readers);
absl::Status SetJourneyWriter(Connection& connection, const std::string& name,
                              const std::string& writer_id);

}  // namespace homing::storage

#endif  // STORAGE_JOURNEY_ROWS_H_
