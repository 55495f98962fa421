// One stream of one writer: observations to durable steps, each acknowledged after its commit.
// Source: own design (resumable recording).
#ifndef SERVER_SESSION_RECORDING_SESSION_H_
#define SERVER_SESSION_RECORDING_SESSION_H_

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/journey/journey_recorder.h"
#include "server/catalog/journey_catalog.h"
#include "storage/commit_queue.h"

namespace homing::server {

struct RecordingAnswer {
  // Absent in the first answer.
  std::optional<std::int64_t> sequence;
  // First that is not durable.
  std::int64_t next_sequence = 0;
  // First answer only.
  std::optional<std::int64_t> resend_from;
  std::optional<JourneyStep> step;
};

// Who is told; calls come one at a time, from those who record and after commits, and must not call
// back into the session. After `end` nothing comes.
struct RecordingListener {
  std::function<void(RecordingAnswer)> answer;
  std::function<void(absl::Status)> end;
};

// What a session works with; all outlive it.
struct RecordingContext {
  JourneyCatalog* catalog = nullptr;
  storage::CommitQueue* queue = nullptr;
  DecodeLimits limits;
};

// Observations are numbered by the client. One that is durable already is accepted and stores
// nothing; from `resend_from` on they rebuild the state of tracking. A gap is OUT_OF_RANGE and says
// which is due. With frames, a stream that goes on at next_sequence without the look-back has a
// gap, unless the observation is marked as a break. Record is for one thread at a time.
class RecordingSession : public std::enable_shared_from_this<RecordingSession> {
 public:
  // Claims the journey; the first answer is given before this returns. INVALID_ARGUMENT (name,
  // writer_id), and as JourneyCatalog::Claim.
  static absl::StatusOr<std::shared_ptr<RecordingSession>> Open(const RecordingContext& context,
                                                                const std::string& journey,
                                                                const std::string& writer_id,
                                                                TimePoint now,
                                                                RecordingListener listener);

  ~RecordingSession();
  RecordingSession(const RecordingSession&) = delete;
  RecordingSession& operator=(const RecordingSession&) = delete;

  // One answer or the end comes of it, after those of the observations before.
  void Record(const Observation& observation, TimePoint now);
  // Ends the session with `status` after the answers to the observations before.
  void Reject(const absl::Status& status);

 private:
  struct Slot {
    bool ready = false;
    absl::Status status;
    RecordingAnswer answer;
  };

  RecordingSession(const RecordingContext& context, RecordingListener listener)
      : context_(context), listener_(std::move(listener)) {}
  absl::Status Start(WriterClaim claim);
  absl::Status Process(const Observation& observation, TimePoint now, std::int64_t slot);
  absl::Status CheckDue(const Observation& observation) const;
  absl::Status CheckKind(const Observation& observation);
  absl::Status Commit(storage::JourneyAppend append, std::int64_t slot);
  std::int64_t OpenSlot();
  void Complete(std::int64_t slot, const absl::Status& status, RecordingAnswer answer);
  void Deliver(Slot slot);
  void End(const absl::Status& status);
  bool ended();

  const RecordingContext context_;
  WriterClaim claim_;
  std::optional<JourneyRecorder> recorder_;
  InputKind kind_ = InputKind::kUnknown;
  // Next to feed to the recorder, and next to make durable; the first is behind while resending.
  std::int64_t due_ = 0;
  std::int64_t next_ = 0;

  std::mutex mutex_;
  const RecordingListener listener_;
  // Answers in the order of the observations; those of repeats wait for the commits before.
  std::deque<Slot> slots_;
  std::int64_t first_slot_ = 0;
  // As of the last answer delivered.
  std::int64_t durable_next_ = 0;
  bool ended_ = false;
};

}  // namespace homing::server

#endif  // SERVER_SESSION_RECORDING_SESSION_H_
