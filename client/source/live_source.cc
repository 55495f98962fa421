#include "client/source/live_source.h"

#include <thread>

#include "homing/base/mutex.h"

namespace homing::client {
namespace {

using Frame = absl::StatusOr<std::optional<SourceFrame>>;

// Shared with the thread that reads, which may hang in the camera's driver and outlive the source.
struct Mailbox {
  Mutex mutex;
  ConditionVariable changed;
  // The frame that was read but not taken yet: the reader waits, so that a pipe loses nothing.
  std::optional<Frame> frame HOMING_GUARDED_BY(mutex);
  bool closed HOMING_GUARDED_BY(mutex) = false;
};

void ReadAll(const std::shared_ptr<Mailbox>& mailbox, const std::shared_ptr<FrameSource>& camera) {
  while (true) {
    Frame frame = camera->Next();
    const bool last = !frame.ok() || !frame->has_value();
    const MutexLock lock(mailbox->mutex);
    while (!mailbox->closed && mailbox->frame) mailbox->changed.Wait(mailbox->mutex);
    if (mailbox->closed) return;
    mailbox->frame = std::move(frame);
    mailbox->changed.NotifyAll();
    if (last) return;
  }
}

class StoppableSource : public FrameSource {
 public:
  StoppableSource(std::shared_ptr<FrameSource> camera, std::stop_token stop)
      : stop_(std::move(stop)), camera_(std::move(camera)) {}
  ~StoppableSource() override {
    const MutexLock lock(mailbox_->mutex);
    mailbox_->closed = true;
    mailbox_->changed.NotifyAll();
  }

  Frame Next() override {
    if (!started_) {
      started_ = true;
      std::thread(ReadAll, mailbox_, camera_).detach();
    }
    if (!error_.ok()) return error_;
    const std::stop_callback wake_up(stop_, [this] {
      const MutexLock lock(mailbox_->mutex);
      mailbox_->changed.NotifyAll();
    });
    const MutexLock lock(mailbox_->mutex);
    while (!ended_ && !mailbox_->frame && !stop_.stop_requested()) {
      mailbox_->changed.Wait(mailbox_->mutex);
    }
    if (ended_ || !mailbox_->frame) return std::optional<SourceFrame>();
    Frame frame = *std::move(mailbox_->frame);
    mailbox_->frame.reset();
    ended_ = !frame.ok() || !frame->has_value();
    // Every source returns its error again.
    error_ = frame.status();
    mailbox_->changed.NotifyAll();
    return frame;
  }
  bool Seek(std::int64_t) override { return false; }
  bool live() const override { return true; }

 private:
  std::stop_token stop_;
  std::shared_ptr<FrameSource> camera_;
  std::shared_ptr<Mailbox> mailbox_ = std::make_shared<Mailbox>();
  bool started_ = false;
  bool ended_ = false;
  absl::Status error_;
};

}  // namespace

std::unique_ptr<FrameSource> MakeStoppable(std::unique_ptr<FrameSource> camera,
                                           std::stop_token stop) {
  return std::make_unique<StoppableSource>(std::move(camera), std::move(stop));
}

}  // namespace homing::client
