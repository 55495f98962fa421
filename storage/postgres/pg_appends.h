// Appending steps in PostgreSQL: one statement a batch, which the database fences.
#ifndef STORAGE_POSTGRES_PG_APPENDS_H_
#define STORAGE_POSTGRES_PG_APPENDS_H_

#include <functional>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "storage/growing_journey.h"
#include "storage/journey_store.h"
#include "storage/postgres/pg_connection.h"
#include "storage/postgres/pg_step_rows.h"

namespace homing::storage::postgres {

// A live connection that writes; opens one if necessary.
using Writer = std::function<absl::StatusOr<PgConnection*>(Deadline)>;

// The rows of journeys that this server records are kept between batches: the statement changes
// only those whose epoch, next_sequence and state are still the same, and returns which. Not
// thread-safe.
class PgAppends {
 public:
  // As JourneyStore::AppendSteps. After a commit whose result is unknown it connects again and
  // reads the journeys: nothing is guessed. UNAVAILABLE after `deadline`.
  std::vector<absl::Status> Append(const std::vector<JourneyAppend>& appends, const Writer& writer,
                                   Deadline deadline);
  // Call it after other code changed the row.
  void Forget(const std::string& name) { journeys_.erase(name); }

 private:
  // The content of one statement: appends that are not yet decided and fit.
  struct Batch {
    std::vector<std::size_t> appends;
    // The changed journeys, in order of id, with next_sequence as it must be before.
    std::map<std::int64_t, std::pair<GrowingJourney*, std::int64_t>> journeys;
    StepColumns steps;
  };
  enum class Outcome { kDecided, kAgain };

  Outcome TryOnce(const std::vector<JourneyAppend>& appends, const Writer& writer,
                  Deadline deadline);
  absl::StatusOr<Batch> Plan(const std::vector<JourneyAppend>& appends, PgConnection& connection,
                             Deadline deadline);
  absl::StatusOr<GrowingJourney*> Find(const std::string& name, PgConnection& connection,
                                       Deadline deadline);
  // The keys of the journeys that grew.
  absl::StatusOr<PgRows> Send(const Batch& batch, PgConnection& connection, Deadline deadline);
  void Decide(const std::vector<JourneyAppend>& appends, const Batch& batch, const PgRows& grown);
  absl::Status ResolveDoubt(const std::vector<JourneyAppend>& appends, const Batch& batch,
                            const Writer& writer, Deadline deadline);
  void FailUndecided(const absl::Status& status);

  std::unordered_map<std::string, GrowingJourney> journeys_;
  // Results of this call's appends; UNKNOWN: not decided yet.
  std::vector<absl::Status> statuses_;
};

}  // namespace homing::storage::postgres

#endif  // STORAGE_POSTGRES_PG_APPENDS_H_
