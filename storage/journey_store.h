// Journeys on disk: one interface, SQLite behind it. Source: own design.
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

// What is kept of a journey beside its map.
struct JourneyRecord {
  // "robots/{robot}/journeys/{journey}".
  std::string name;
  JourneySettings settings;
  JourneyState state = JourneyState::kActive;
  // Who writes; empty: nobody said.
  std::string writer_id;
  std::vector<std::string> readers;
  InputKind input = InputKind::kUnknown;
  // First sequence that is not durable.
  std::int64_t next_sequence = 0;
  // Nanoseconds since the epoch; 0: not given. create: server's clock; start, end: robot's, of the
  // first and the last step.
  std::int64_t create_time_ns = 0;
  std::int64_t start_time_ns = 0;
  std::int64_t end_time_ns = 0;
  // Filled by reads; ignored by writes.
  std::int64_t step_count = 0;
  std::int32_t landmark_count = 0;
  std::int64_t fingerprint_count = 0;
};

// What one observation adds to a journey. Without a step: the number alone becomes durable.
struct JourneyAppend {
  std::string journey;
  // Becomes next_sequence - 1.
  std::int64_t sequence = 0;
  InputKind input = InputKind::kUnknown;
  std::int64_t capture_time_ns = 0;
  std::optional<JourneyStep> step;
  // Set when an image size became known with this observation.
  std::optional<JourneySettings> settings;
};

struct StoredModel {
  // "deviationModels/{model}".
  std::string name;
  DeviationModel model;
  TrainingOptions training;
  std::int64_t create_time_ns = 0;
};

// Thread-safe. Every write is one transaction and durable (synchronous) when it returns OK. Codes
// besides those named: UNAVAILABLE (busy; the disk does not answer), RESOURCE_EXHAUSTED (disk
// full), DATA_LOSS (corrupt), FAILED_PRECONDITION (read-only), INTERNAL.
class JourneyStore {
 public:
  virtual ~JourneyStore() = default;

  // ALREADY_EXISTS.
  virtual absl::Status CreateJourney(const JourneyRecord& record) = 0;
  // NOT_FOUND.
  virtual absl::StatusOr<JourneyRecord> GetJourney(const std::string& name) = 0;
  // In order of name, those after `after` whose name begins with `prefix`; at most `limit`.
  virtual absl::StatusOr<std::vector<JourneyRecord>> ListJourneys(const std::string& prefix,
                                                                  const std::string& after,
                                                                  int limit) = 0;
  // NOT_FOUND.
  virtual absl::Status DeleteJourney(const std::string& name) = 0;
  // NOT_FOUND. OK when already finished.
  virtual absl::Status FinishJourney(const std::string& name) = 0;
  // The writer changed. NOT_FOUND.
  virtual absl::Status SetWriter(const std::string& name, const std::string& writer_id) = 0;
  // NOT_FOUND.
  virtual absl::Status SetReaders(const std::string& name,
                                  const std::vector<std::string>& readers) = 0;
  // Appends to any number of journeys in ONE transaction; the status of each (a journey gone,
  // finished, or a sequence that is not next: NOT_FOUND, FAILED_PRECONDITION, OUT_OF_RANGE for that
  // one only). When the transaction itself fails, every entry has its error and nothing is stored.
  virtual std::vector<absl::Status> AppendSteps(const std::vector<JourneyAppend>& appends) = 0;
  // The map as stored. NOT_FOUND, DATA_LOSS.
  virtual absl::StatusOr<JourneyMap> LoadMap(const std::string& name) = 0;
  // What recording goes on from; takes as long however long the journey is. NOT_FOUND, DATA_LOSS.
  virtual absl::StatusOr<JourneyTail> LoadTail(const std::string& name) = 0;
  // A whole journey at once, finished. ALREADY_EXISTS, INVALID_ARGUMENT.
  virtual absl::Status ImportJourney(const JourneyRecord& record, const JourneyMap& map) = 0;

  // How the last write fared: OK, or the fault of the store that it met (no room, no access, the
  // disk does not answer). A store that was opened read-only is well.
  virtual absl::Status WriteHealth() { return absl::OkStatus(); }
  // Writes a little that changes nothing, to find out. Returns WriteHealth.
  virtual absl::Status ProbeWrite() { return absl::OkStatus(); }
  virtual bool read_only() const { return false; }

  // A copy of the whole as of one moment, checked; it takes room beside the file until it is let go
  // of. FAILED_PRECONDITION (in memory, or read-only: the file itself may be copied), ABORTED
  // (another copy is being made), RESOURCE_EXHAUSTED.
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
  // "sqlite:PATH"; the file is made if it does not exist. "sqlite::memory:" for tests.
  std::string url = "sqlite:homing.db";
  // How long to wait for a lock, ms.
  int busy_timeout_ms = 5000;
  // Most that the file may grow to, bytes; a write beyond it is RESOURCE_EXHAUSTED. 0: no limit.
  std::int64_t max_bytes = 0;
  // Changes no byte of the file and needs no write access to where it lies. The file must have been
  // closed well and be of this program's schema.
  bool read_only = false;
};

// INVALID_ARGUMENT (URL), FAILED_PRECONDITION (schema newer than this program; read-only: also an
// older one, or a log that is not yet in the file), DATA_LOSS, UNAVAILABLE (in use).
absl::StatusOr<std::unique_ptr<JourneyStore>> OpenJourneyStore(const StoreOptions& options);

}  // namespace homing::storage

#endif  // STORAGE_JOURNEY_STORE_H_
