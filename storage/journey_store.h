// The interface to stored journeys, and its options.
#ifndef STORAGE_JOURNEY_STORE_H_
#define STORAGE_JOURNEY_STORE_H_

#include <cstdint>
#include <istream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/journey/journey_map.h"
#include "homing/journey/journey_recorder.h"
#include "homing/similarity/deviation_training.h"

namespace homing::storage {

enum class JourneyState { kActive = 1, kFinished = 2 };

// A journey without its map.
struct JourneyRecord {
  // "robots/{robot}/journeys/{journey}".
  std::string name;
  JourneySettings settings;
  JourneyState state = JourneyState::kActive;
  // The current writer; empty: none was given.
  std::string writer_id;
  std::vector<std::string> readers;
  InputKind input = InputKind::kUnknown;
  // The first sequence that is not committed.
  std::int64_t next_sequence = 0;
  // The first observation that a resumed recording needs: for frames the reference, else
  // next_sequence.
  std::int64_t resend_from = 0;
  // Nanoseconds since the epoch; 0: not given. create: by the server's clock. start and end: by the
  // robot's clock, of the first and last step.
  std::int64_t create_time_ns = 0;
  std::int64_t start_time_ns = 0;
  std::int64_t end_time_ns = 0;
  // Filled by reads; ignored by writes.
  std::int64_t step_count = 0;
  std::int32_t landmark_count = 0;
  std::int64_t fingerprint_count = 0;
};

// The part that one observation adds to a journey. If it made no step, only the sequence is stored.
struct JourneyAppend {
  std::string journey;
  // Becomes next_sequence - 1.
  std::int64_t sequence = 0;
  InputKind input = InputKind::kUnknown;
  std::int64_t capture_time_ns = 0;
  std::optional<JourneyStep> step;
  // Set if this observation made an image size known.
  std::optional<JourneySettings> settings;
  // Becomes the journey's resend_from.
  std::int64_t resend_from = 0;
  // AcquiredJourney::epoch of its writer; 0: nobody has acquired the journey.
  std::int64_t epoch = 0;
};

// A journey that one writer may append to, until another one acquires it.
struct AcquiredJourney {
  // Fences earlier writers: grows with each acquisition. Above 0.
  std::int64_t epoch = 0;
  // As of the acquisition: no append of an earlier epoch is stored after it.
  JourneyRecord record;
};

// Shows whether a journey in memory is still as stored.
struct JourneyMark {
  std::string name;
  // Distinguishes a journey from a later one of the same name.
  std::int64_t create_time_ns = 0;
  JourneyState state = JourneyState::kActive;
  std::int64_t next_sequence = 0;
  std::int64_t epoch = 0;
  // Changes with each change of the readers.
  std::int64_t revision = 0;
};

// The part of a journey from one step on.
struct JourneyGrowth {
  JourneyRecord record;
  // In order; steps without a row are left out.
  std::vector<JourneyStep> steps;
};

struct StoredModel {
  // "deviationModels/{model}".
  std::string name;
  DeviationModel model;
  TrainingOptions training;
  std::int64_t create_time_ns = 0;
};

// Thread-safe. Every write is one transaction, and durable (synchronous) when it returns OK.
// Further codes: UNAVAILABLE (busy, or the disk does not answer), RESOURCE_EXHAUSTED (disk full),
// DATA_LOSS (corrupt), FAILED_PRECONDITION (read-only), INTERNAL.
class JourneyStore {
 public:
  virtual ~JourneyStore() = default;

  // ALREADY_EXISTS.
  virtual absl::Status CreateJourney(const JourneyRecord& record) = 0;
  // NOT_FOUND.
  virtual absl::StatusOr<JourneyRecord> GetJourney(const std::string& name) = 0;
  // The records after the name `after` whose names begin with `prefix`; at most `limit`, in order
  // of name.
  virtual absl::StatusOr<std::vector<JourneyRecord>> ListJourneys(const std::string& prefix,
                                                                  const std::string& after,
                                                                  int limit) = 0;
  // NOT_FOUND.
  virtual absl::Status DeleteJourney(const std::string& name) = 0;
  // NOT_FOUND. OK if already finished.
  virtual absl::Status FinishJourney(const std::string& name) = 0;
  // Gives the journey to `writer_id`: appends of earlier epochs are ABORTED from now on. NOT_FOUND;
  // FAILED_PRECONDITION: finished; ABORTED: as CheckLease.
  virtual absl::StatusOr<AcquiredJourney> AcquireJourney(const std::string& name,
                                                         const std::string& writer_id) = 0;
  // ABORTED: another server that is alive has written the journey in the last 15 s for a writer of
  // another program (the part of a writer_id before "#" names it).
  virtual absl::Status CheckLease(const std::string& /*name*/, const std::string& /*writer_id*/) {
    return absl::OkStatus();
  }
  // NOT_FOUND.
  virtual absl::Status SetReaders(const std::string& name,
                                  const std::vector<std::string>& readers) = 0;
  // Appends to any number of journeys in one transaction. Returns a status each: NOT_FOUND
  // (deleted), FAILED_PRECONDITION (finished), ABORTED (another epoch), OUT_OF_RANGE (the sequence
  // is not the next) concern one append. If the transaction fails, every append has its error. A
  // store behind a network may have stored appends that have the error UNAVAILABLE: AcquireJourney
  // decides.
  virtual std::vector<absl::Status> AppendSteps(const std::vector<JourneyAppend>& appends) = 0;
  // The map as stored. NOT_FOUND, DATA_LOSS.
  virtual absl::StatusOr<JourneyMap> LoadMap(const std::string& name) = 0;
  // The record and the steps from `first` on, of one moment. NOT_FOUND, DATA_LOSS.
  virtual absl::StatusOr<JourneyGrowth> LoadSteps(const std::string& name, std::int64_t first) = 0;
  // The marks of the given journeys that exist.
  virtual absl::StatusOr<std::vector<JourneyMark>> LoadMarks(
      const std::vector<std::string>& names) = 0;
  // State needed to resume recording; O(1) in journey length. NOT_FOUND, DATA_LOSS.
  virtual absl::StatusOr<JourneyTail> LoadTail(const std::string& name) = 0;
  // Stores a whole journey, finished. ALREADY_EXISTS, INVALID_ARGUMENT.
  virtual absl::Status ImportJourney(const JourneyRecord& record, const JourneyMap& map) = 0;

  // The result of the last write: OK, or the fault of the store (no space, no access, the disk does
  // not answer). OK for a read-only store.
  virtual absl::Status WriteHealth() { return absl::OkStatus(); }
  // Tests with a small write that changes nothing. Returns WriteHealth.
  virtual absl::Status ProbeWrite() { return absl::OkStatus(); }
  virtual bool read_only() const { return false; }
  // Other servers write to it too.
  virtual bool shared() const { return false; }

  // A checked copy of the whole store as of one moment. It takes disk space until the stream is
  // destroyed. FAILED_PRECONDITION (in memory; or read-only, where the file itself may be copied),
  // ABORTED (another copy is being made), RESOURCE_EXHAUSTED.
  virtual absl::StatusOr<std::unique_ptr<std::istream>> BackUp() {
    return absl::FailedPreconditionError("store: it cannot be copied");
  }

  // ALREADY_EXISTS.
  virtual absl::Status CreateModel(const StoredModel& model) = 0;
  // NOT_FOUND.
  virtual absl::StatusOr<StoredModel> GetModel(const std::string& name) = 0;
  virtual absl::StatusOr<std::vector<StoredModel>> ListModels(const std::string& after,
                                                              int limit) = 0;
};

struct StoreOptions {
  // "sqlite:PATH"; the file is created if missing. "sqlite::memory:" for tests. Or
  // "postgresql://...", as libpq reads it; the tables are created if missing.
  std::string url = "sqlite:homing.db";
  // How long to wait for a lock, ms.
  int busy_timeout_ms = 5000;
  // Largest size of the file, bytes; a write beyond it is RESOURCE_EXHAUSTED. 0: no limit. SQLite.
  std::int64_t max_bytes = 0;
  // Changes no byte of the file, and needs no write access to its folder. The file must have been
  // closed cleanly and have this program's schema.
  bool read_only = false;
};

// INVALID_ARGUMENT (URL); UNAVAILABLE (in use); DATA_LOSS; FAILED_PRECONDITION: the schema is newer
// than this program; PostgreSQL: commits are not synchronous; read-only: also an older schema, or a
// log that is not yet in the file.
absl::StatusOr<std::unique_ptr<JourneyStore>> OpenJourneyStore(const StoreOptions& options);

}  // namespace homing::storage

#endif  // STORAGE_JOURNEY_STORE_H_
