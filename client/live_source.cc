#include "client/live_source.h"

#include <condition_variable>
#include <mutex>
#include <thread>

namespace homing::client {
namespace {

using Frame = absl::StatusOr<std::optional<SourceFrame>>;

// Shared with the thread that reads, which may hang in the camera's driver and outlive the source.
struct Mailbox {
  std::mutex mutex;
  std::condition_variable_any changed;
  // The frame read and not yet taken: the reader waits, so that a pipe loses nothing.
  std::optional<Frame> frame;
  bool closed = false;
};

void ReadAll(const std::shared_ptr<Mailbox>& mailbox, const std::shared_ptr<FrameSource>& camera) {
  while (true) {
    Frame frame = camera->Next();
    const bool last = !frame.ok() || !frame->has_value();
    std::unique_lock lock(mailbox->mutex);
    mailbox->changed.wait(lock, [&] { return mailbox->closed || !mailbox->frame; });
    if (mailbox->closed) return;
    mailbox->frame = std::move(frame);
    mailbox->changed.notify_all();
    if (last) return;
  }
}

class StoppableSource : public FrameSource {
 public:
  StoppableSource(std::shared_ptr<FrameSource> camera, std::stop_token stop)
      : stop_(std::move(stop)), camera_(std::move(camera)) {}
  ~StoppableSource() override {
    const std::lock_guard lock(mailbox_->mutex);
    mailbox_->closed = true;
    mailbox_->changed.notify_all();
  }

  Frame Next() override {
    if (!started_) {
      started_ = true;
      std::thread(ReadAll, mailbox_, camera_).detach();
    }
    if (!error_.ok()) return error_;
    std::unique_lock lock(mailbox_->mutex);
    const auto has_frame = [&] { return mailbox_->frame.has_value(); };
    if (ended_ || !mailbox_->changed.wait(lock, stop_, has_frame)) {
      return std::optional<SourceFrame>();
    }
    Frame frame = *std::move(mailbox_->frame);
    mailbox_->frame.reset();
    ended_ = !frame.ok() || !frame->has_value();
    // Given again, as by every source.
    error_ = frame.status();
    mailbox_->changed.notify_all();
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
