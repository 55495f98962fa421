// Records an outbound journey. Observations wait in a bounded buffer on this robot's disk while the
// link is down, and survive a restart of the program.
#ifndef HOMING_CLIENT_RECORDER_H_
#define HOMING_CLIENT_RECORDER_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "homing/client/observation.h"
#include "homing/client/server.h"
#include "homing/client/status.h"

namespace homing::robot {

// The server's answer to one observation, which is durable now.
struct Recorded {
  // Number of the observation in the journey, from 0.
  std::int64_t sequence = 0;
  // Unset: it made no step.
  std::optional<std::int64_t> step = {};
  Motion motion = Motion::kUnknown;
  // Number of landmarks seen.
  int landmarks = 0;
};

struct RecorderOptions {
  // "robots/ROBOT/journeys/JOURNEY". It is created unless this writer has begun it already.
  std::string journey = "";
  // The same after each restart of this program. Required.
  std::string writer = "";
  std::optional<Camera> left_camera = {};
  std::optional<Camera> right_camera = {};
  // File of the buffer; one a journey. Empty: the buffer is in memory only.
  std::string buffer_file = "";
  // Most bytes of observations that wait.
  std::int64_t buffer_bytes = std::int64_t{256} << 20;
  // Most observations that wait in memory. The disk is written only when more of them wait, and
  // when the recorder is destroyed. 0: each one is written to disk at once.
  int memory_observations = 32;
  // Called in order, on another thread.
  std::function<void(const Recorded&)> on_recorded = {};
  // Messages for the user about the link, on another thread.
  std::function<void(const std::string&)> on_message = {};
};

// Thread-safe.
class Recorder {
 public:
  // Does not wait for the server. INVALID_ARGUMENT; FAILED_PRECONDITION: the buffer holds another
  // journey, or another program uses it.
  static Result<std::unique_ptr<Recorder>> Open(const Server& server, RecorderOptions options);
  // Observations that were not sent stay in the buffer file.
  ~Recorder();

  // Never waits for the link. RESOURCE_EXHAUSTED: the buffer is full, the observation is dropped.
  // Other errors end the recording.
  Status Add(const Observation& observation);

  // Observations that are not durable yet.
  std::int64_t pending() const;

  // Waits until everything is durable, then closes the journey. DEADLINE_EXCEEDED: not within
  // `timeout`; the waiting observations stay in the buffer file. Nothing can be added afterwards.
  Status Finish(std::chrono::milliseconds timeout);

 private:
  class State;
  explicit Recorder(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace homing::robot

#endif  // HOMING_CLIENT_RECORDER_H_
