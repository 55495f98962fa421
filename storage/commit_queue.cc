#include "storage/commit_queue.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"

namespace homing::storage {

struct CommitQueue::State {
  struct Committed {
    std::vector<JourneyAppend> appends;
    std::vector<Done> callbacks;
    std::vector<absl::Status> statuses;
  };

  JourneyStore* const store;
  const CommitQueueOptions options;

  std::mutex mutex;
  std::condition_variable changed;
  // Guarded by mutex. The two have equal length.
  std::deque<JourneyAppend> appends;
  std::deque<Done> callbacks;
  bool stopping = false;
  // Appends in the last transaction.
  std::size_t last_batch = 0;
  // The next transaction begins at a time, or when full_batch appends are there: one more does not
  // matter.
  bool gathering = false;
  // Whose transactions have ended.
  std::deque<Committed> committed;
  std::condition_variable ended;
  bool all_committed = false;

  std::thread committing;
  std::thread telling;

  State(JourneyStore* s, const CommitQueueOptions& o) : store(s), options(o) {}
  void Commit();
  void Tell();
  bool TakeBatch(std::vector<JourneyAppend>& batch, std::vector<Done>& done);
};

// Waits for work. False: stopped, and nothing is left.
bool CommitQueue::State::TakeBatch(std::vector<JourneyAppend>& batch, std::vector<Done>& done) {
  std::unique_lock lock(mutex);
  changed.wait(lock, [this] { return stopping || !appends.empty(); });
  if (last_batch >= options.busy_batch) {
    gathering = true;
    changed.wait_for(lock, options.gather_time,
                     [this] { return stopping || appends.size() >= options.full_batch; });
    gathering = false;
  }
  const std::size_t limit = static_cast<std::size_t>(std::max(1, options.max_batch));
  const auto size = static_cast<std::ptrdiff_t>(std::min(appends.size(), limit));
  batch.assign(std::move_iterator(appends.begin()), std::move_iterator(appends.begin() + size));
  done.assign(std::move_iterator(callbacks.begin()), std::move_iterator(callbacks.begin() + size));
  appends.erase(appends.begin(), appends.begin() + size);
  callbacks.erase(callbacks.begin(), callbacks.begin() + size);
  last_batch = static_cast<std::size_t>(size);
  return size > 0;
}

void CommitQueue::State::Commit() {
  Committed batch;
  while (TakeBatch(batch.appends, batch.callbacks)) {
    batch.statuses = store->AppendSteps(batch.appends);
    {
      const std::lock_guard lock(mutex);
      committed.push_back(std::exchange(batch, {}));
    }
    ended.notify_one();
  }
  {
    const std::lock_guard lock(mutex);
    all_committed = true;
  }
  ended.notify_one();
}

void CommitQueue::State::Tell() {
  std::unique_lock lock(mutex);
  while (true) {
    ended.wait(lock, [this] { return all_committed || !committed.empty(); });
    if (committed.empty()) return;
    Committed batch = std::move(committed.front());
    committed.pop_front();
    lock.unlock();
    for (std::size_t i = 0; i < batch.callbacks.size(); ++i) {
      batch.callbacks[i](std::move(batch.appends[i]), batch.statuses[i]);
      // What the callback holds must not outlive its turn.
      batch.callbacks[i] = nullptr;
    }
    lock.lock();
  }
}

CommitQueue::CommitQueue(JourneyStore* store, const CommitQueueOptions& options)
    : state_(std::make_unique<State>(store, options)) {
  state_->committing = std::thread([state = state_.get()] { state->Commit(); });
  state_->telling = std::thread([state = state_.get()] { state->Tell(); });
}

CommitQueue::~CommitQueue() {
  {
    std::lock_guard lock(state_->mutex);
    state_->stopping = true;
  }
  state_->changed.notify_one();
  state_->committing.join();
  state_->telling.join();
}

std::size_t CommitQueue::waiting() const {
  std::lock_guard lock(state_->mutex);
  return state_->appends.size();
}

absl::Status CommitQueue::Submit(JourneyAppend append, Done done) {
  bool begins = false;
  {
    std::lock_guard lock(state_->mutex);
    if (state_->appends.size() >= static_cast<std::size_t>(state_->options.max_pending)) {
      return absl::ResourceExhaustedError(
          absl::StrCat("commit queue is full: at most ", state_->options.max_pending, " wait"));
    }
    state_->appends.push_back(std::move(append));
    state_->callbacks.push_back(std::move(done));
    begins = !state_->gathering || state_->appends.size() >= state_->options.full_batch;
  }
  if (begins) state_->changed.notify_one();
  return absl::OkStatus();
}

}  // namespace homing::storage
