#include "storage/commit_queue.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

#include "absl/strings/str_cat.h"

namespace homing::storage {

struct CommitQueue::State {
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

  std::thread thread;

  State(JourneyStore* s, const CommitQueueOptions& o) : store(s), options(o) {}
  void Run();
  bool TakeBatch(std::vector<JourneyAppend>& batch, std::vector<Done>& done);
};

// Waits for work. False: stopped, and nothing is left.
bool CommitQueue::State::TakeBatch(std::vector<JourneyAppend>& batch, std::vector<Done>& done) {
  std::unique_lock lock(mutex);
  changed.wait(lock, [this] { return stopping || !appends.empty(); });
  if (last_batch >= options.busy_batch) {
    changed.wait_for(lock, options.gather_time,
                     [this] { return stopping || appends.size() >= options.full_batch; });
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

void CommitQueue::State::Run() {
  std::vector<JourneyAppend> batch;
  std::vector<Done> done;
  while (TakeBatch(batch, done)) {
    const std::vector<absl::Status> statuses = store->AppendSteps(batch);
    for (std::size_t i = 0; i < done.size(); ++i) {
      done[i](std::move(batch[i]), statuses[i]);
      // What the callback holds must not live until the next batch.
      done[i] = nullptr;
    }
  }
}

CommitQueue::CommitQueue(JourneyStore* store, const CommitQueueOptions& options)
    : state_(std::make_unique<State>(store, options)) {
  state_->thread = std::thread([state = state_.get()] { state->Run(); });
}

CommitQueue::~CommitQueue() {
  {
    std::lock_guard lock(state_->mutex);
    state_->stopping = true;
  }
  state_->changed.notify_one();
  state_->thread.join();
}

std::size_t CommitQueue::waiting() const {
  std::lock_guard lock(state_->mutex);
  return state_->appends.size();
}

absl::Status CommitQueue::Submit(JourneyAppend append, Done done) {
  {
    std::lock_guard lock(state_->mutex);
    if (state_->appends.size() >= static_cast<std::size_t>(state_->options.max_pending)) {
      return absl::ResourceExhaustedError(
          absl::StrCat("commit queue is full: at most ", state_->options.max_pending, " wait"));
    }
    state_->appends.push_back(std::move(append));
    state_->callbacks.push_back(std::move(done));
  }
  state_->changed.notify_one();
  return absl::OkStatus();
}

}  // namespace homing::storage
