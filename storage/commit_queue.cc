#include "storage/commit_queue.h"

#include <algorithm>
#include <deque>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "homing/base/mutex.h"

namespace homing::storage {

struct CommitQueue::State {
  struct Committed {
    std::vector<JourneyAppend> appends;
    std::vector<Done> callbacks;
    std::vector<absl::Status> statuses;
  };

  JourneyStore* const store;
  const CommitQueueOptions options;

  Mutex mutex;
  ConditionVariable changed;
  // `appends` and `callbacks` have equal length.
  std::deque<JourneyAppend> appends HOMING_GUARDED_BY(mutex);
  std::deque<Done> callbacks HOMING_GUARDED_BY(mutex);
  bool stopping HOMING_GUARDED_BY(mutex) = false;
  // Appends in the last transaction.
  std::size_t last_batch HOMING_GUARDED_BY(mutex) = 0;
  // The next transaction begins at a set time, or once full_batch appends wait: Submit need not
  // wake the thread for each append.
  bool gathering HOMING_GUARDED_BY(mutex) = false;
  // Transactions that have ended and are not yet reported.
  std::deque<Committed> committed HOMING_GUARDED_BY(mutex);
  ConditionVariable ended;
  bool all_committed HOMING_GUARDED_BY(mutex) = false;

  std::thread committing;
  std::thread calling_back;

  State(JourneyStore* s, const CommitQueueOptions& o) : store(s), options(o) {}
  void Commit();
  void CallBack();
  void Report(const std::vector<absl::Status>& statuses, std::chrono::duration<double> time) const;
  bool TakeBatch(std::vector<JourneyAppend>& batch, std::vector<Done>& done);
};

void CommitQueue::State::Report(const std::vector<absl::Status>& statuses,
                                std::chrono::duration<double> time) const {
  if (options.on_commit) {
    const auto stored = std::count_if(statuses.begin(), statuses.end(),
                                      [](const absl::Status& status) { return status.ok(); });
    options.on_commit(static_cast<int>(stored), stored > 0, time);
  }
}

// Waits for appends. False: stopped, and nothing is left.
bool CommitQueue::State::TakeBatch(std::vector<JourneyAppend>& batch, std::vector<Done>& done) {
  MutexLock lock(mutex);
  while (!stopping && appends.empty()) changed.Wait(mutex);
  if (last_batch >= options.busy_batch) {
    gathering = true;
    const auto end = std::chrono::steady_clock::now() + options.gather_time;
    while (!stopping && appends.size() < options.full_batch && changed.WaitUntil(mutex, end)) {
    }
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
    const auto begin = std::chrono::steady_clock::now();
    batch.statuses = store->AppendSteps(batch.appends);
    Report(batch.statuses, std::chrono::steady_clock::now() - begin);
    {
      const MutexLock lock(mutex);
      committed.push_back(std::exchange(batch, {}));
    }
    ended.NotifyOne();
  }
  {
    const MutexLock lock(mutex);
    all_committed = true;
  }
  ended.NotifyOne();
}

void CommitQueue::State::CallBack() {
  MutexLock lock(mutex);
  while (true) {
    while (!all_committed && committed.empty()) ended.Wait(mutex);
    if (committed.empty()) return;
    Committed batch = std::move(committed.front());
    committed.pop_front();
    lock.Unlock();
    for (std::size_t i = 0; i < batch.callbacks.size(); ++i) {
      batch.callbacks[i](std::move(batch.appends[i]), batch.statuses[i]);
      // Release the objects that the callback holds before the next callback runs.
      batch.callbacks[i] = nullptr;
    }
    lock.Lock();
  }
}

CommitQueue::CommitQueue(JourneyStore* store, const CommitQueueOptions& options)
    : state_(std::make_unique<State>(store, options)) {
  state_->committing = std::thread([state = state_.get()] { state->Commit(); });
  state_->calling_back = std::thread([state = state_.get()] { state->CallBack(); });
}

CommitQueue::~CommitQueue() {
  {
    const MutexLock lock(state_->mutex);
    state_->stopping = true;
  }
  state_->changed.NotifyOne();
  state_->committing.join();
  state_->calling_back.join();
}

std::size_t CommitQueue::waiting() const {
  const MutexLock lock(state_->mutex);
  return state_->appends.size();
}

absl::Status CommitQueue::Submit(JourneyAppend append, Done done) {
  bool begins = false;
  {
    const MutexLock lock(state_->mutex);
    if (state_->appends.size() >= static_cast<std::size_t>(state_->options.max_pending)) {
      return absl::ResourceExhaustedError(
          absl::StrCat("commit queue is full: at most ", state_->options.max_pending, " wait"));
    }
    state_->appends.push_back(std::move(append));
    state_->callbacks.push_back(std::move(done));
    begins = !state_->gathering || state_->appends.size() >= state_->options.full_batch;
  }
  if (begins) state_->changed.NotifyOne();
  return absl::OkStatus();
}

}  // namespace homing::storage
