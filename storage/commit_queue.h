// Group commit: appends of many streams share transactions.
#ifndef STORAGE_COMMIT_QUEUE_H_
#define STORAGE_COMMIT_QUEUE_H_

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>

#include "storage/journey_store.h"

namespace homing::storage {

struct CommitQueueOptions {
  // Most appends waiting; Submit blocks no one: it refuses above this. [1, 1'000'000].
  int max_pending = 32768;
  // Most appends in one transaction.
  int max_batch = 1024;
  // After a transaction of at least `busy_batch` appends the next one waits so long for more to
  // come, unless `full_batch` are there: transactions have a cost of their own, most of all on a
  // disk whose syncs are quick. A robot alone is never kept waiting.
  std::size_t busy_batch = 5;
  std::size_t full_batch = 256;
  std::chrono::milliseconds gather_time{2};
  // Called by the committing thread after each transaction, unless empty: how many appends were
  // stored, whether the transaction succeeded, and how long it took.
  std::function<void(int stored, bool ok, std::chrono::duration<double> time)> on_commit;
};

// One thread commits all that waits, in order of submission; another calls back, so that the next
// transaction goes on meanwhile. Thread-safe.
class CommitQueue {
 public:
  // Called after the transaction ended, with what was to be appended, one at a time and in order of
  // submission.
  using Done = std::function<void(JourneyAppend, absl::Status)>;

  // `store` must outlive the queue.
  explicit CommitQueue(JourneyStore* store, const CommitQueueOptions& options = {});
  // Commits all that waits, calls back, then stops.
  ~CommitQueue();

  // RESOURCE_EXHAUSTED when full (`done` is then not called, and `append` is lost).
  absl::Status Submit(JourneyAppend append, Done done);
  // Appends that wait for their transaction to begin.
  std::size_t waiting() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace homing::storage

#endif  // STORAGE_COMMIT_QUEUE_H_
