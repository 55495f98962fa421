// Observations between the robot's cameras and the stream to the server: bounded, in memory first,
// on disk when many wait.
#ifndef CLIENT_ROBOT_OBSERVATION_BUFFER_H_
#define CLIENT_ROBOT_OBSERVATION_BUFFER_H_

#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <string>

#include "client/observation_stream.h"
#include "client/robot/observation_file.h"
#include "homing/base/mutex.h"

namespace homing::robot {

struct BufferOptions {
  std::int64_t max_bytes = 0;
  std::int64_t max_observations = 0;
  int memory_observations = 0;
};

// One thread reads it as a stream; any thread may add, acknowledge and close.
class ObservationBuffer : public client::ObservationStream {
 public:
  // Numbers continue after those of `file`.
  static absl::StatusOr<std::unique_ptr<ObservationBuffer>> Create(
      const BufferOptions& options, std::optional<ObservationFile> file);
  // Writes the observations in memory to the file; the file is empty if nothing waits.
  ~ObservationBuffer() override;

  // Numbers the observation. RESOURCE_EXHAUSTED: full; also errors of the file. One that is refused
  // is not kept. Returns its number.
  absl::StatusOr<std::int64_t> Add(v1::Observation observation);
  // The server has all before `durable`, and may ask for `reference` again.
  void Acknowledge(std::int64_t durable, std::int64_t reference);
  // Nothing is added any more: Next returns std::nullopt behind the last one.
  void Close();
  // Next returns std::nullopt at once.
  void Stop();
  std::int64_t pending() const;
  // Waits until there is an observation to send. False: stopped.
  bool Await();

  // Renumbers for a server that has all observations before `durable`: those added since the buffer
  // was opened are new, whatever their number was. If the first ones that the server needs are not
  // there any more (it lost confirmed ones), the others follow at once, behind a break. Returns how
  // many are missing. Call it once, before the first Next.
  absl::StatusOr<std::int64_t> Align(std::int64_t durable);

  // Waits for the next one. std::nullopt: closed.
  absl::StatusOr<std::optional<v1::Observation>> Next() override;
  bool Seek(std::int64_t sequence) override;
  void ContinueAt(std::int64_t sequence) override;

 private:
  ObservationBuffer(const BufferOptions& options, std::optional<ObservationFile> file,
                    const ObservationFile::Extent& extent);

  std::int64_t pending_count() const HOMING_REQUIRES(mutex_) { return end_ - durable_; }
  absl::Status WriteToFile() HOMING_REQUIRES(mutex_);
  // Adds `shift` to the numbers from `first` on; those include that of opened_at_.
  absl::Status Renumber(std::int64_t first, std::int64_t shift) HOMING_REQUIRES(mutex_);
  // As Align, for a server that needs `durable`, which is not new.
  absl::StatusOr<std::int64_t> CloseGap(std::int64_t durable) HOMING_REQUIRES(mutex_);
  // The first observation with at least this sequence.
  absl::StatusOr<std::optional<StoredObservation>> Find(std::int64_t sequence) const
      HOMING_REQUIRES(mutex_);

  const BufferOptions options_;
  mutable Mutex mutex_;
  ConditionVariable changed_;
  std::optional<ObservationFile> file_ HOMING_GUARDED_BY(mutex_);
  // Observations after those of the file.
  std::deque<StoredObservation> memory_ HOMING_GUARDED_BY(mutex_);
  std::int64_t memory_bytes_ HOMING_GUARDED_BY(mutex_) = 0;
  std::int64_t file_bytes_ HOMING_GUARDED_BY(mutex_) = 0;
  std::int64_t file_end_ HOMING_GUARDED_BY(mutex_) = 0;
  // The number of the next one to add; the first added by this process.
  std::int64_t end_ HOMING_GUARDED_BY(mutex_) = 0;
  std::int64_t opened_at_ HOMING_GUARDED_BY(mutex_) = 0;
  std::int64_t durable_ HOMING_GUARDED_BY(mutex_) = 0;
  // The number that Next returns next, and those that are marked as breaks.
  std::int64_t cursor_ HOMING_GUARDED_BY(mutex_) = 0;
  std::set<std::int64_t> breaks_ HOMING_GUARDED_BY(mutex_);
  // An observation was dropped: flow before the next one is missing.
  bool dropped_ HOMING_GUARDED_BY(mutex_) = false;
  bool closed_ HOMING_GUARDED_BY(mutex_) = false;
  bool stopped_ HOMING_GUARDED_BY(mutex_) = false;
};

}  // namespace homing::robot

#endif  // CLIENT_ROBOT_OBSERVATION_BUFFER_H_
