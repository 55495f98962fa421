// Localises a robot that acts on the answers: sends what it sees as it sees it, and hands over the
// answers as they arrive, over any number of broken links.
#ifndef CLIENT_LIVE_LOCALIZER_H_
#define CLIENT_LIVE_LOCALIZER_H_

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "absl/status/statusor.h"
#include "client/homing_client.h"

namespace homing::client {

// The methods are called by one thread; a thread inside talks to the server.
class LiveLocalizer {
 public:
  // REQUIRES: `connection` outlives it.
  LiveLocalizer(
      const Connection* connection, const LocalizingOptions& options, Log log = [](auto&) {});
  // Breaks off.
  ~LiveLocalizer();

  // The next observation; it is numbered here, from 0. Returns its number.
  std::int64_t Send(v1::Observation observation);
  // The next answer, if one is there. After an error there are no more. Errors as Localize.
  absl::StatusOr<std::optional<v1::LocalizeResponse>> Poll();
  // The next answer. REQUIRES: one is due.
  absl::StatusOr<v1::LocalizeResponse> Wait();

 private:
  class Queue;

  void Run(const LocalizingOptions& options, const std::stop_token& stop);
  // The next answer or the error. REQUIRES: one of them, and the lock.
  absl::StatusOr<v1::LocalizeResponse> Take();

  HomingClient client_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<v1::Observation> observations_;
  std::deque<v1::LocalizeResponse> answers_;
  // Set when the stream has ended.
  std::optional<absl::Status> ended_;
  std::int64_t next_ = 0;
  std::jthread thread_;
};

}  // namespace homing::client

#endif  // CLIENT_LIVE_LOCALIZER_H_
