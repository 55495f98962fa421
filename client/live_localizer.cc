#include "client/live_localizer.h"

#include <utility>

namespace homing::client {

// The observations to send, in the order of Send.
class LiveLocalizer::Queue final : public ObservationStream {
 public:
  Queue(LiveLocalizer* owner, std::stop_token stop) : owner_(owner), stop_(std::move(stop)) {}

  absl::StatusOr<std::optional<v1::Observation>> Next() override {
    std::unique_lock lock(owner_->mutex_);
    auto& waiting = owner_->observations_;
    if (!owner_->changed_.wait(lock, stop_, [&] { return !waiting.empty(); })) {
      return absl::CancelledError("stopped");
    }
    v1::Observation next = std::move(waiting.front());
    waiting.pop_front();
    return std::make_optional(std::move(next));
  }
  bool Seek(std::int64_t) override { return false; }
  // Does nothing: localising never goes back beyond the kept observations.
  void ContinueAt(std::int64_t) override {}

 private:
  LiveLocalizer* owner_;
  std::stop_token stop_;
};

LiveLocalizer::LiveLocalizer(const Connection* connection, const LocalizingOptions& options,
                             Log log)
    : client_(connection, std::move(log)),
      thread_([this, options](const std::stop_token& stop) { Run(options, stop); }) {}

LiveLocalizer::~LiveLocalizer() = default;

void LiveLocalizer::Run(const LocalizingOptions& options, const std::stop_token& stop) {
  Queue queue(this, stop);
  const absl::Status status = client_.Localize(
      options, &queue,
      [this](const v1::LocalizeResponse& answer) {
        const std::lock_guard lock(mutex_);
        answers_.push_back(answer);
        changed_.notify_all();
        return absl::OkStatus();
      },
      stop);
  const std::lock_guard lock(mutex_);
  ended_ = status.ok() ? absl::UnavailableError("the stream has ended") : status;
  changed_.notify_all();
}

std::int64_t LiveLocalizer::Send(v1::Observation observation) {
  const std::lock_guard lock(mutex_);
  observation.set_sequence(next_);
  observations_.push_back(std::move(observation));
  changed_.notify_all();
  return next_++;
}

absl::StatusOr<v1::LocalizeResponse> LiveLocalizer::Take() {
  if (answers_.empty()) return *ended_;
  v1::LocalizeResponse answer = std::move(answers_.front());
  answers_.pop_front();
  return answer;
}

absl::StatusOr<std::optional<v1::LocalizeResponse>> LiveLocalizer::Poll() {
  const std::lock_guard lock(mutex_);
  if (answers_.empty() && !ended_) return std::optional<v1::LocalizeResponse>();
  auto answer = Take();
  if (!answer.ok()) return answer.status();
  return std::make_optional(*std::move(answer));
}

absl::StatusOr<v1::LocalizeResponse> LiveLocalizer::Wait(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  const bool has = changed_.wait(lock, stop, [this] { return !answers_.empty() || ended_; });
  if (!has) return absl::CancelledError("stopped");
  return Take();
}

}  // namespace homing::client
