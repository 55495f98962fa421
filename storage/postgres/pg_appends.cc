#include "storage/postgres/pg_appends.h"

#include <set>
#include <thread>
#include <utility>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "storage/postgres/pg_journey_rows.h"
#include "storage/postgres/pg_status.h"
#include "storage/row_words.h"
#include "storage/settings_json.h"

namespace homing::storage::postgres {
namespace {

// The row lock of each journey orders this with every other writer of it. Of two that expect the
// same row, the second one finds another and stores nothing.
constexpr char kAppend[] =
    "WITH b AS (SELECT * FROM unnest($1::bigint[], $2::bigint[], $3::bigint[], $4::bigint[],"
    " $5::bigint[], $6::text[], $7::bigint[], $8::bigint[], $9::bigint[], $10::bigint[],"
    " $11::bigint[], $12::text[]) AS b(journey_id, epoch, expected, next_sequence, resend_from,"
    " input, first_time, last_time, step_count, landmark_count, new_fingerprints, settings)),"
    " grown AS (UPDATE journeys j SET next_sequence = b.next_sequence,"
    " resend_from = b.resend_from, input = b.input,"
    " start_time_ns = CASE start_time_ns WHEN 0 THEN b.first_time ELSE start_time_ns END,"
    " end_time_ns = CASE b.last_time WHEN 0 THEN end_time_ns ELSE b.last_time END,"
    " step_count = b.step_count, landmark_count = b.landmark_count,"
    " fingerprint_count = fingerprint_count + b.new_fingerprints, written_at = now()"
    " FROM b WHERE j.journey_id = b.journey_id AND j.epoch = b.epoch"
    " AND j.next_sequence = b.expected AND j.state = 'ACTIVE' RETURNING j.journey_id),"
    " changed AS (UPDATE journey_settings s SET settings = b.settings FROM b JOIN grown USING"
    " (journey_id) WHERE s.journey_id = b.journey_id AND b.settings IS NOT NULL),"
    " stored AS (INSERT INTO steps SELECT s.journey_id, step, nullif(sequence, -1), fingerprints,"
    " left_profile, right_profile FROM unnest($13::bigint[], $14::bigint[], $15::bigint[],"
    " $16::bytea[], $17::bytea[], $18::bytea[]) AS s(journey_id, step, sequence, fingerprints,"
    " left_profile, right_profile) JOIN grown ON grown.journey_id = s.journey_id)"
    " SELECT journey_id FROM grown";

// Waits for the row locks of a transaction that may still be under way. It is a write, so that its
// own commit reaches the replica after everything that it has read.
constexpr char kResolve[] =
    "UPDATE journeys SET server_id = server_id WHERE journey_id = ANY($1)"
    " RETURNING journey_id, epoch, next_sequence";

// Journeys kept between batches; about a kilobyte each.
constexpr std::size_t kMostKept = 16384;
constexpr std::chrono::milliseconds kStatementTime{5000};
constexpr std::chrono::milliseconds kPause{50};

Deadline Earlier(Deadline a, Deadline b) { return a < b ? a : b; }

}  // namespace

absl::StatusOr<GrowingJourney*> PgAppends::Find(const std::string& name, PgConnection& connection,
                                                Deadline deadline) {
  if (const auto known = journeys_.find(name); known != journeys_.end()) return &known->second;
  HOMING_ASSIGN_OR_RETURN(GrowingJourney journey, FindGrowing(connection, name, deadline));
  return &journeys_.emplace(name, std::move(journey)).first->second;
}

// Sets the statuses of appends that cannot be stored. Returns the connection's errors only.
absl::StatusOr<PgAppends::Batch> PgAppends::Plan(const std::vector<JourneyAppend>& appends,
                                                 PgConnection& connection, Deadline deadline) {
  Batch batch;
  for (std::size_t i = 0; i < appends.size(); ++i) {
    if (!absl::IsUnknown(statuses_[i])) continue;
    const JourneyAppend& append = appends[i];
    const auto found = Find(append.journey, connection, deadline);
    absl::Status status = found.status();
    if (found.ok()) {
      GrowingJourney& journey = **found;
      const std::int64_t expected = journey.next_sequence;
      status = Grow(journey, append, [&](const GrowingJourney& grown, std::int32_t landmark) {
        return FindSide(connection, grown.id, landmark, deadline);
      });
      if (status.ok()) {
        batch.journeys.try_emplace(journey.id, &journey, expected);
        batch.appends.push_back(i);
        if (append.step) batch.steps.Add(journey.id, *append.step);
      }
    }
    if (connection.is_lost()) return status;
    if (!status.ok()) statuses_[i] = status;
  }
  return batch;
}

absl::StatusOr<PgRows> PgAppends::Send(const Batch& batch, PgConnection& connection,
                                       Deadline deadline) {
  std::vector<std::vector<std::int64_t>> numbers(10);
  std::vector<std::string> inputs;
  std::vector<std::optional<std::string>> settings;
  for (const auto& [id, changed] : batch.journeys) {
    const GrowingJourney& journey = *changed.first;
    const std::int64_t columns[] = {id,
                                    journey.epoch,
                                    changed.second,
                                    journey.next_sequence,
                                    journey.resend_from,
                                    journey.first_time_ns,
                                    journey.last_time_ns,
                                    journey.step_count,
                                    journey.landmark_count,
                                    journey.new_fingerprints};
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i].push_back(columns[i]);
    inputs.push_back(Word(journey.input));
    settings.push_back(journey.new_settings ? std::optional(ToJson(*journey.new_settings))
                                            : std::nullopt);
  }
  PgArguments arguments;
  for (std::size_t i = 0; i < 5; ++i) arguments.Integers(numbers[i]);
  arguments.Texts(inputs);
  for (std::size_t i = 5; i < numbers.size(); ++i) arguments.Integers(numbers[i]);
  arguments.Texts(settings);
  batch.steps.AddTo(&arguments);
  return connection.Run(kAppend, arguments, deadline);
}

// The rows of journeys that did not grow differ from the kept ones and are read again.
void PgAppends::Decide(const std::vector<JourneyAppend>& appends, const Batch& batch,
                       const PgRows& grown) {
  std::set<std::int64_t> ids;
  for (int row = 0; row < grown.size(); ++row) ids.insert(grown.Integer(row, 0));
  for (const auto& [id, changed] : batch.journeys) {
    if (ids.contains(id)) MarkWritten(*changed.first);
  }
  for (const std::size_t i : batch.appends) {
    if (ids.contains(JourneyId(appends[i].journey))) {
      statuses_[i] = absl::OkStatus();
    } else {
      Forget(appends[i].journey);
    }
  }
}

absl::Status PgAppends::ResolveDoubt(const std::vector<JourneyAppend>& appends, const Batch& batch,
                                     const Writer& writer, Deadline deadline) {
  std::vector<std::int64_t> ids;
  for (const auto& [id, changed] : batch.journeys) ids.push_back(id);
  for (const std::size_t i : batch.appends) Forget(appends[i].journey);
  absl::Status error = absl::UnavailableError("store: the database does not answer");
  while (std::chrono::steady_clock::now() < deadline) {
    const Deadline statement = Earlier(deadline, After(kStatementTime));
    const auto connection = writer(statement);
    const auto rows = connection.ok()
                          ? (*connection)->Run(kResolve, PgArguments().Integers(ids), statement)
                          : connection.status();
    if (!rows.ok()) {
      error = rows.status();
      std::this_thread::sleep_for(kPause);
      continue;
    }
    std::map<std::int64_t, std::pair<std::int64_t, std::int64_t>> stored;
    for (int row = 0; row < rows->size(); ++row) {
      stored[rows->Integer(row, 0)] = {rows->Integer(row, 1), rows->Integer(row, 2)};
    }
    for (const std::size_t i : batch.appends) {
      const auto found = stored.find(JourneyId(appends[i].journey));
      // Only this server writes with this epoch. Under another epoch the next attempt returns the
      // error.
      if (found != stored.end() && found->second.first == appends[i].epoch &&
          found->second.second > appends[i].sequence) {
        statuses_[i] = absl::OkStatus();
      }
    }
    return absl::OkStatus();
  }
  return error;
}

void PgAppends::FailUndecided(const absl::Status& status) {
  for (absl::Status& undecided : statuses_) {
    if (absl::IsUnknown(undecided)) undecided = status;
  }
  journeys_.clear();
}

PgAppends::Outcome PgAppends::TryOnce(const std::vector<JourneyAppend>& appends,
                                      const Writer& writer, Deadline deadline) {
  const Deadline statement = Earlier(deadline, After(kStatementTime));
  const auto connection = writer(statement);
  if (!connection.ok()) {
    if (absl::IsUnavailable(connection.status()) && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(kPause);
      return Outcome::kAgain;
    }
    FailUndecided(connection.status());
    return Outcome::kDecided;
  }
  const auto batch = Plan(appends, **connection, statement);
  if (!batch.ok()) {
    journeys_.clear();
    return Outcome::kAgain;
  }
  if (batch->appends.empty()) return Outcome::kDecided;
  const auto grown = Send(*batch, **connection, statement);
  if (grown.ok()) {
    Decide(appends, *batch, *grown);
    return Outcome::kAgain;
  }
  if ((*connection)->in_doubt()) {
    const absl::Status resolved = ResolveDoubt(appends, *batch, writer, deadline);
    if (resolved.ok()) return Outcome::kAgain;
    FailUndecided(resolved);
    return Outcome::kDecided;
  }
  journeys_.clear();
  // The transaction was certainly rolled back.
  if (IsConflict(grown.status())) return Outcome::kAgain;
  FailUndecided(grown.status());
  return Outcome::kDecided;
}

std::vector<absl::Status> PgAppends::Append(const std::vector<JourneyAppend>& appends,
                                            const Writer& writer, Deadline deadline) {
  statuses_.assign(appends.size(), absl::UnknownError("undecided"));
  if (journeys_.size() > kMostKept) journeys_.clear();
  while (TryOnce(appends, writer, deadline) == Outcome::kAgain) {
    if (std::chrono::steady_clock::now() > deadline) {
      FailUndecided(absl::UnavailableError("store: the database does not answer"));
    }
  }
  return std::exchange(statuses_, {});
}

}  // namespace homing::storage::postgres
