// Localises a robot that acts on the answers: sends observations as they are made, and returns the
// answers as they arrive, across any number of broken links.
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

// One thread calls the methods; an inner thread calls the server.
class LiveLocalizer {
 public:
  // REQUIRES: `connection` outlives it.
  LiveLocalizer(
      const Connection* connection, const LocalizingOptions& options, Log log = [](auto&) {});
  // Cancels the stream.
  ~LiveLocalizer();

  // Numbers the observation, from 0, and sends it. Returns its number.
  std::int64_t Send(v1::Observation observation);
  // The next answer, if one has arrived. After an error there are no more. Errors as Localize.
  absl::StatusOr<std::optional<v1::LocalizeResponse>> Poll();
  // Waits for the next answer. CANCELLED: stopped. REQUIRES: an observation is not answered yet.
  absl::StatusOr<v1::LocalizeResponse> Wait(const std::stop_token& stop = {});

 private:
  class Queue;

  void Run(const LocalizingOptions& options, const std::stop_token& stop);
  // The next answer or the error. REQUIRES: one of them exists, and the lock is held.
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
