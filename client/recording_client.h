// Records a journey: durable, resumable, over any number of broken links.
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
  // "robots/{robot}/journeys/{journey}"; it exists.
  std::string journey;
  // Survives restarts of this program.
  std::string writer_id;
  // Most observations sent and not yet acknowledged. [1, 10000].
  int window = 256;
  // Acknowledged observations kept for a resend. [0, 10000].
  int keep = 8;
};

struct RecordingSummary {
  // First sequence that is not durable: all are.
  std::int64_t next_sequence = 0;
  // Where this run began: what was durable before.
  std::int64_t begun_at = 0;
  int reconnects = 0;
};

// One recording. Not thread-safe.
class RecordingClient {
 public:
  // Each observation's answer at most once, in order, on another thread. An error stops the
  // recording.
  using OnAnswer = std::function<absl::Status(const v1::RecordJourneyResponse&)>;

  // REQUIRES: `connection` outlives the client.
  RecordingClient(
      const Connection* connection, RecordingOptions options, Log log = [](auto&) {});

  // Sends `observations` from where the server says to the end; returns when all are durable.
  // CANCELLED: stopped, what is durable stays. Others as RecordJourney.
  absl::StatusOr<RecordingSummary> Record(ObservationStream* observations,
                                          const OnAnswer& on_answer,
                                          const std::stop_token& stop = {});

 private:
  using Stream =
      grpc::ClientReaderWriterInterface<v1::RecordJourneyRequest, v1::RecordJourneyResponse>;

  absl::Status Attempt(ResendBuffer* buffer, const OnAnswer& on_answer, const std::stop_token& stop,
                       bool* progress);
  // Config out, first answer in, buffer rewound.
  absl::Status Begin(Stream* stream, ResendBuffer* buffer);
  absl::Status Answer(const v1::RecordJourneyResponse& response, ResendBuffer* buffer,
                      const OnAnswer& on_answer, bool* progress);

  const Connection* connection_;
  RecordingOptions options_;
  Log log_;
  std::unique_ptr<v1::JourneyService::StubInterface> stub_;
  RecordingSummary summary_;
  int attempts_ = 0;
  // Last sequence handed to on_answer.
  std::int64_t reported_ = -1;
};

}  // namespace homing::client

#endif  // CLIENT_RECORDING_CLIENT_H_
