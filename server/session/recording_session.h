// One writer's stream: observations become committed steps, and each is acknowledged after its
// commit.
#ifndef SERVER_SESSION_RECORDING_SESSION_H_
#define SERVER_SESSION_RECORDING_SESSION_H_

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/base/mutex.h"
#include "homing/journey/journey_recorder.h"
#include "server/catalog/journey_catalog.h"
#include "storage/commit_queue.h"

namespace homing::server {

struct RecordingAnswer {
  // Absent in the first answer.
  std::optional<std::int64_t> sequence;
  // The first sequence that is not committed.
  std::int64_t next_sequence = 0;
  // The observation to send again after a broken link, before next_sequence: for frames, the
  // reference.
  std::int64_t resend_from = 0;
  std::optional<JourneyStep> step;
  // The observation was compared with the reference and made no step.
  bool is_standing = false;
  // The frame of the observation; in the first answer, of the last step, if there is one.
  std::optional<std::int64_t> frame;
};

// Receives answers and the end, one call at a time, from recording threads and after commits. It
// must not call the session. Nothing follows `end`.
struct RecordingListener {
  std::function<void(RecordingAnswer)> answer;
  std::function<void(absl::Status)> end;
};

// Shared objects; all must outlive the session.
struct RecordingContext {
  JourneyCatalog* catalog = nullptr;
  storage::CommitQueue* queue = nullptr;
  DecodeLimits limits;
};

// The client numbers its observations. A committed one is accepted again and stores nothing; the
// reference frame, `resend_from`, rebuilds the tracker's state. A gap is OUT_OF_RANGE with the
// expected number. With frames, a stream that starts at next_sequence without the reference has a
// gap, unless the observation is marked as a break. The observations in between made no step and
// need not be sent again. One thread at a time may call Record.
class RecordingSession : public std::enable_shared_from_this<RecordingSession> {
 public:
  // Claims the journey and sends the first answer before it returns. INVALID_ARGUMENT (name,
  // writer_id); errors of JourneyCatalog::Claim.
  static absl::StatusOr<std::shared_ptr<RecordingSession>> Open(const RecordingContext& context,
                                                                const std::string& journey,
                                                                const std::string& writer_id,
                                                                TimePoint now,
                                                                RecordingListener listener);

  ~RecordingSession();
  RecordingSession(const RecordingSession&) = delete;
  RecordingSession& operator=(const RecordingSession&) = delete;

  // Each call leads to one answer or to the end, after the answers to earlier observations.
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
      : context_(context),
        image_memory_(context.catalog->beliefs()),
        listener_(std::move(listener)) {}
  absl::Status Start(WriterClaim claim);
  absl::Status Process(const Observation& observation, TimePoint now, std::int64_t slot);
  absl::Status CheckExpected(const Observation& observation) const;
  absl::Status CheckKind(const Observation& observation);
  // Takes the memory in which the recorder tracks frames. RESOURCE_EXHAUSTED.
  absl::Status TakeImageMemory();
  absl::Status Commit(storage::JourneyAppend append, RecordingAnswer answer, std::int64_t slot);
  std::int64_t OpenSlot();
  void Complete(std::int64_t slot, const absl::Status& status, RecordingAnswer answer);
  void Deliver(Slot slot) HOMING_REQUIRES(mutex_);
  void End(const absl::Status& status);
  bool ended();

  const RecordingContext context_;
  WriterClaim claim_;
  std::optional<JourneyRecorder> recorder_;
  InputKind kind_ = InputKind::kUnknown;
  MemoryBudget::Share image_memory_;
  // Next sequence for the recorder, and next sequence to commit. After a resumption `expected_` is
  // the reference's, until the client has sent the reference again.
  std::int64_t expected_ = 0;
  std::int64_t next_ = 0;

  Mutex mutex_;
  const RecordingListener listener_;
  // Answers in the order of the observations. An answer to a repeat waits for earlier commits.
  std::deque<Slot> slots_ HOMING_GUARDED_BY(mutex_);
  std::int64_t first_slot_ HOMING_GUARDED_BY(mutex_) = 0;
  // The values of the last answer sent.
  std::int64_t durable_next_ HOMING_GUARDED_BY(mutex_) = 0;
  std::int64_t durable_resend_from_ HOMING_GUARDED_BY(mutex_) = 0;
  bool ended_ HOMING_GUARDED_BY(mutex_) = false;
};

}  // namespace homing::server

#endif  // SERVER_SESSION_RECORDING_SESSION_H_
