// One robot of a load: a stream on its own connection, which sends at given times.
#ifndef CLIENT_BENCH_LOAD_ROBOT_H_
#define CLIENT_BENCH_LOAD_ROBOT_H_

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/bench/http2_call.h"
#include "client/bench/latencies.h"
#include "homing/v1/homing_service.pb.h"
#include "homing/v1/journey_service.pb.h"

namespace homing::client {

using LoadClock = std::chrono::steady_clock;

// How long a fleet that begins in one instant may take until its latencies are as usual.
inline constexpr std::chrono::seconds kSettling{10};

// The result of one robot, or of all.
struct LoadCounts {
  std::int64_t sent = 0;
  std::int64_t answered = 0;
  // Sent more than 10 ms late: the client or the link could not keep up.
  std::int64_t late = 0;
  Latencies latency;
  // Of each robot's first observation.
  Latencies first;
  // Of the observations scheduled kSettling or more after the robot's first.
  Latencies settled;
  absl::Status status;

  // All but the status.
  void Add(const LoadCounts& other) {
    sent += other.sent;
    answered += other.answered;
    late += other.late;
    latency.Add(other.latency);
    first.Add(other.first);
    settled.Add(other.settled);
  }
};

// The answered observation; -1: none (the answer to the config).
inline std::int64_t AnsweredSequence(const v1::RecordJourneyResponse& response) {
  return response.has_sequence() ? response.sequence() : -1;
}
inline std::int64_t AnsweredSequence(const v1::LocalizeResponse& response) {
  return response.sequence();
}

// Latencies count from the time at which an observation should leave, not from the write, so that
// every queue counts. For one thread.
template <typename Request, typename Response>
class LoadRobot {
 public:
  // The requests that robots send repeatedly, without the observation's sequence.
  using Requests = std::vector<std::string>;

  // Calls `method` and sends the config. `requests` must outlive it.
  static absl::StatusOr<std::unique_ptr<LoadRobot>> Start(const Http2Endpoint& endpoint,
                                                          const std::string& method,
                                                          const Request& config,
                                                          const Requests* requests) {
    std::unique_ptr<LoadRobot> robot(new LoadRobot(requests));
    auto call = Http2Call::Open(endpoint, method, [robot = robot.get()](std::string_view message) {
      robot->Answered(message);
    });
    if (!call.ok()) return call.status();
    robot->call_ = *std::move(call);
    robot->call_->Queue(config.SerializeAsString());
    robot->call_->Flush();
    return robot;
  }

  int socket() const { return call_->socket(); }
  bool done() const { return call_->done(); }

  // Schedules the next observation for `time`.
  void Schedule(LoadClock::time_point time) {
    if (!begin_) begin_ = time;
    scheduled_.push_back(time);
    SendScheduled();
  }

  // Nothing more will be scheduled.
  void HalfClose() {
    closing_ = true;
    SendScheduled();
  }

  // The socket has data, has room, or was closed.
  void Advance(LoadClock::time_point now, bool hung_up) {
    now_ = now;
    call_->Receive(hung_up);
    SendScheduled();
  }

  // Cancels the stream unless it has ended.
  LoadCounts End() {
    call_->Cancel();
    counts_.status = call_->status();
    return counts_;
  }

 private:
  explicit LoadRobot(const Requests* requests) : requests_(*requests) {}

  void SendScheduled() {
    while (!scheduled_.empty() && call_->sent_all() && !call_->done()) {
      constexpr std::chrono::milliseconds kLate{10};
      if (LoadClock::now() - scheduled_.front() > kLate) ++counts_.late;
      waiting_.push_back(scheduled_.front());
      scheduled_.pop_front();
      const std::string& request =
          requests_[static_cast<std::size_t>(counts_.sent) % requests_.size()];
      // The parts of a message may follow each other: protobuf merges them.
      numbered_.mutable_observation()->set_sequence(counts_.sent++);
      call_->Queue(request, numbered_.SerializeAsString());
      call_->Flush();
    }
    if (closing_ && scheduled_.empty()) {
      closing_ = false;
      call_->HalfClose();
      call_->Flush();
    }
  }

  void Answered(std::string_view message) {
    if (!response_.ParseFromArray(message.data(), static_cast<int>(message.size()))) {
      return call_->Cancel();
    }
    if (AnsweredSequence(response_) < 0 || waiting_.empty()) return;
    const auto latency = now_ - waiting_.front();
    if (counts_.answered == 0) counts_.first.Add(latency);
    if (waiting_.front() - *begin_ >= kSettling) counts_.settled.Add(latency);
    counts_.latency.Add(latency);
    waiting_.pop_front();
    ++counts_.answered;
  }

  const Requests& requests_;
  std::unique_ptr<Http2Call> call_;
  Request numbered_;
  Response response_;
  LoadClock::time_point now_;
  // The scheduled time of the first observation.
  std::optional<LoadClock::time_point> begin_;
  // Scheduled times of observations that are not sent, and of those not answered.
  std::deque<LoadClock::time_point> scheduled_;
  std::deque<LoadClock::time_point> waiting_;
  LoadCounts counts_;
  bool closing_ = false;
};

}  // namespace homing::client

#endif  // CLIENT_BENCH_LOAD_ROBOT_H_
