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
  // Most waiting appends; Submit never blocks, it refuses more. [1, 1'000'000].
  int max_pending = 32768;
  // Most appends in one transaction.
  int max_batch = 1024;
  // After a transaction of at least `busy_batch` appends, the next one waits this long for more, or
  // until it has `full_batch`: each transaction has a fixed cost, which dominates on a disk with
  // fast syncs. A single robot never waits.
  std::size_t busy_batch = 5;
  std::size_t full_batch = 256;
  std::chrono::milliseconds gather_time{2};
  // Called by the committing thread after each transaction, unless empty: how many appends were
  // stored, whether the transaction succeeded, and how long it took.
  std::function<void(int stored, bool ok, std::chrono::duration<double> time)> on_commit = nullptr;
};

// One thread commits the waiting appends in their order; another one calls back, so that the next
// transaction runs meanwhile. Thread-safe.
class CommitQueue {
 public:
  // Called after the transaction, with the append and its result, one call at a time, in the order
  // of submission.
  using Done = std::function<void(JourneyAppend, absl::Status)>;

  // `store` must outlive the queue.
  explicit CommitQueue(JourneyStore* store, const CommitQueueOptions& options = {});
  // Commits all waiting appends, calls back, then stops.
  ~CommitQueue();

  // RESOURCE_EXHAUSTED when full (`done` is then not called, and `append` is lost).
  absl::Status Submit(JourneyAppend append, Done done);
  // Appends whose transaction has not begun.
  std::size_t waiting() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace homing::storage

#endif  // STORAGE_COMMIT_QUEUE_H_
