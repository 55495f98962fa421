#include "client/answer_limit.h"

#include "absl/strings/str_cat.h"

namespace homing::client {

AnswerLimit::AnswerLimit(grpc::ClientContext* context, std::chrono::milliseconds limit)
    : context_(context), limit_(limit), thread_([this] { Watch(); }) {}

AnswerLimit::~AnswerLimit() {
  {
    const MutexLock lock(mutex_);
    ended_ = true;
    changed_.NotifyAll();
  }
  thread_.join();
}

void AnswerLimit::Await() {
  const MutexLock lock(mutex_);
  if (awaited_++ > 0) return;
  since_ = Clock::now();
  changed_.NotifyAll();
}

void AnswerLimit::Answered() {
  const MutexLock lock(mutex_);
  // A server may answer twice.
  if (awaited_ > 0) --awaited_;
  is_reading_ = false;
}

void AnswerLimit::Continue() {
  const MutexLock lock(mutex_);
  is_reading_ = true;
  since_ = Clock::now();
  changed_.NotifyAll();
}

absl::Status AnswerLimit::Explain(const absl::Status& status) const {
  const MutexLock lock(mutex_);
  if (!expired_) return status;
  return absl::UnavailableError(
      absl::StrCat("the server did not answer for ", limit_.count(), " ms"));
}

void AnswerLimit::Watch() {
  const MutexLock lock(mutex_);
  while (!ended_ && !expired_) {
    if (awaited_ == 0 || !is_reading_) {
      changed_.Wait(mutex_);
      continue;
    }
    changed_.WaitUntil(mutex_, since_ + limit_);
    expired_ = !ended_ && awaited_ > 0 && is_reading_ && Clock::now() >= since_ + limit_;
  }
  if (expired_) context_->TryCancel();
}

}  // namespace homing::client
