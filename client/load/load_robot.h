// One robot of a load: a stream of its own connection, sent to at given times. Source: own design.
#ifndef CLIENT_LOAD_LOAD_ROBOT_H_
#define CLIENT_LOAD_LOAD_ROBOT_H_

#include <grpcpp/client_context.h>
#include <grpcpp/support/client_callback.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>

#include "absl/status/status.h"
#include "client/load/latency_histogram.h"
#include "client/rpc_status.h"
#include "homing/v1/homing_service.pb.h"
#include "homing/v1/journey_service.pb.h"

namespace homing::client {

using LoadClock = std::chrono::steady_clock;

// What came of one robot, or of all.
struct LoadCounts {
  std::int64_t sent = 0;
  std::int64_t answered = 0;
  // Sent over 10 ms after their time: the client or the link could not keep up.
  std::int64_t late = 0;
  LatencyHistogram latency;
  absl::Status status;
};

// The observation answered; -1: none (the answer to the config).
inline std::int64_t AnsweredSequence(const v1::RecordJourneyResponse& response) {
  return response.has_sequence() ? response.sequence() : -1;
}
inline std::int64_t AnsweredSequence(const v1::LocalizeResponse& response) {
  return response.sequence();
}

// Latencies run from the time at which an observation was due, not from the write: a queue that
// forms anywhere counts.
template <typename Request, typename Response>
class LoadRobot final : public grpc::ClientBidiReactor<Request, Response> {
 public:
  using Fill = std::function<void(std::int64_t sequence, Request*)>;
  using Open = std::function<void(grpc::ClientContext*, LoadRobot*)>;

  // `fill` makes the request of an observation; called on gRPC's threads and on that of Due.
  LoadRobot(Request config, Fill fill) : fill_(std::move(fill)), request_(std::move(config)) {}

  // `open` names the method. The first message is the config.
  void Start(const Open& open) {
    open(&context_, this);
    this->StartRead(&response_);
    this->StartWrite(&request_);
    this->StartCall();
  }

  // The next observation is to leave at `time`.
  void Due(LoadClock::time_point time) {
    const std::lock_guard lock(mutex_);
    due_.push_back(time);
    WriteNext();
  }

  // Nothing more comes.
  void HalfClose() {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    WriteNext();
  }

  // Waits for the end, and breaks the stream off at `deadline`.
  LoadCounts Await(LoadClock::time_point deadline) {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_until(lock, deadline, [this] { return done_; })) {
      context_.TryCancel();
      changed_.wait(lock, [this] { return done_; });
    }
    return counts_;
  }

  void OnWriteDone(bool ok) override {
    const std::lock_guard lock(mutex_);
    writing_ = !ok;
    WriteNext();
  }

  void OnReadDone(bool ok) override {
    if (!ok) return;
    const LoadClock::time_point now = LoadClock::now();
    {
      const std::lock_guard lock(mutex_);
      if (AnsweredSequence(response_) >= 0 && !waiting_.empty()) {
        counts_.latency.Add(now - waiting_.front());
        waiting_.pop_front();
        ++counts_.answered;
      }
    }
    this->StartRead(&response_);
  }

  void OnDone(const grpc::Status& status) override {
    const std::lock_guard lock(mutex_);
    counts_.status = FromGrpc(status);
    done_ = true;
    changed_.notify_all();
  }

 private:
  // REQUIRES: mutex_.
  void WriteNext() {
    if (writing_ || done_) return;
    if (due_.empty()) {
      if (closing_ && !half_closed_) {
        half_closed_ = true;
        this->StartWritesDone();
      }
      return;
    }
    constexpr std::chrono::milliseconds kLate{10};
    if (LoadClock::now() - due_.front() > kLate) ++counts_.late;
    waiting_.push_back(due_.front());
    due_.pop_front();
    fill_(counts_.sent++, &request_);
    writing_ = true;
    this->StartWrite(&request_);
  }

  const Fill fill_;
  grpc::ClientContext context_;
  Request request_;
  Response response_;

  std::mutex mutex_;
  std::condition_variable changed_;
  // Times of those not yet sent, and of those not yet answered.
  std::deque<LoadClock::time_point> due_;
  std::deque<LoadClock::time_point> waiting_;
  LoadCounts counts_;
  // The config is under way from the start.
  bool writing_ = true;
  bool closing_ = false;
  bool half_closed_ = false;
  bool done_ = false;
};

}  // namespace homing::client

#endif  // CLIENT_LOAD_LOAD_ROBOT_H_
