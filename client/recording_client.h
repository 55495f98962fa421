// Records a journey durably, and resumes after broken links.
#ifndef CLIENT_RECORDING_CLIENT_H_
#define CLIENT_RECORDING_CLIENT_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "absl/status/statusor.h"
#include "client/connection.h"
#include "client/observation_stream.h"
#include "client/reconnect.h"
#include "client/resend_buffer.h"
#include "homing/v1/journey_service.grpc.pb.h"

namespace homing::client {

struct RecordingOptions {
  // "robots/{robot}/journeys/{journey}", which must exist.
  std::string journey;
  // The same after each restart of this program.
  std::string writer_id;
  // Most observations sent and not yet acknowledged. [1, 10000].
  int window = 256;
  // Acknowledged observations that are kept for resending, besides the reference. [0, 10000].
  int keep = 8;
};

struct RecordingSummary {
  // The first sequence that is not durable; all observations are durable.
  std::int64_t next_sequence = 0;
  // The first sequence of this run; earlier ones were already durable.
  std::int64_t begun_at = 0;
  int reconnects = 0;
};

// One recording. Not thread-safe.
class RecordingClient {
 public:
  // Called at most once for each observation's answer, in order, on another thread. An error stops
  // the recording.
  using OnAnswer = std::function<absl::Status(const v1::RecordJourneyResponse&)>;

  // REQUIRES: `connection` outlives the client.
  RecordingClient(
      const Connection* connection, RecordingOptions options, Log log = [](auto&) {});

  // Sends `observations` from the sequence that the server names to the end; returns when all are
  // durable. CANCELLED: stopped; durable observations stay. Errors of RecordJourney.
  absl::StatusOr<RecordingSummary> Record(ObservationStream* observations,
                                          const OnAnswer& on_answer,
                                          const std::stop_token& stop = {});

 private:
  using Stream =
      grpc::ClientReaderWriterInterface<v1::RecordJourneyRequest, v1::RecordJourneyResponse>;

  absl::Status Attempt(ResendBuffer* buffer, const OnAnswer& on_answer, const std::stop_token& stop,
                       bool* progress);
  // Sends the config, reads the first answer and rewinds the buffer.
  absl::Status Begin(Stream* stream, ResendBuffer* buffer, bool* progress);
  absl::Status Answer(const v1::RecordJourneyResponse& response, ResendBuffer* buffer,
                      const OnAnswer& on_answer, bool* progress);

  const Connection* connection_;
  RecordingOptions options_;
  Log log_;
  std::unique_ptr<v1::JourneyService::StubInterface> stub_;
  // The argument of Record.
  ObservationStream* observations_ = nullptr;
  RecordingSummary summary_;
  int attempts_ = 0;
  // The last attempt was reset before it made progress: a proxy may close a stream after so many
  // bytes, and drop what the server did not answer yet.
  bool one_at_a_time_ = false;
  // The last sequence given to on_answer.
  std::int64_t reported_ = -1;
};

}  // namespace homing::client

#endif  // CLIENT_RECORDING_CLIENT_H_
